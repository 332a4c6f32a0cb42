#include "scene/table_reader.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <system_error>

namespace spherule::scene {

namespace {

constexpr std::string_view blanks = " \t";

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

}  // namespace

TableReader::TableReader(Check& check, std::string field, std::filesystem::path path)
    : check_(check), field_(std::move(field)), path_(std::move(path)) {
    auto file = InputFile::open(path_.string());
    if (file)
        lines_.emplace(std::move(*file));
    else
        check_.refuse(field_, file.error().text());
}

bool TableReader::nextLine(std::size_t mostBytes) {
    constexpr std::size_t betweenMarks = 1024;  // lines
    if (!lines_ || !check_.ok()) return false;
    if (line() % betweenMarks == 0 && !check_.goesOn("reading spheres", lines_->bytesRead(), lines_->size()))
        return false;
    length_ = std::string_view::npos;
    const auto more = lines_->next(mostBytes);
    if (!more) check_.refuse(field_, fmt::format("{}:{}: {}", path_.string(), line(), more.error().message));
    return more.value_or(false);
}

void TableReader::refuse(std::size_t column, std::string_view reason) {
    check_.refuse(field_, fmt::format("{}:{}:{}: {}", path_.string(), line(), column, reason));
}

void TableReader::refuse(std::string_view word, std::string_view reason) {
    refuse(static_cast<std::size_t>(word.data() - text().data()) + 1, reason);
}

void TableReader::refuseLine(std::size_t line, std::string_view reason) {
    check_.refuse(field_, fmt::format("{}:{}:1: {}", path_.string(), line, reason));
}

std::vector<std::string_view> TableReader::cells() const {
    std::vector<std::string_view> result;
    const std::string_view whole = text();
    for (std::size_t start = 0; start <= whole.size();) {
        const std::size_t end = std::min(whole.find(',', start), whole.size());
        result.push_back(trimmed(whole.substr(start, end - start)));
        start = end + 1;
    }
    return result;
}

std::vector<std::string_view> TableReader::words() const {
    std::vector<std::string_view> result;
    const std::string_view whole = text();
    for (std::size_t start = 0; (start = whole.find_first_not_of(blanks, start)) != std::string_view::npos;) {
        const std::size_t end = std::min(whole.find_first_of(blanks, start), whole.size());
        result.push_back(whole.substr(start, end - start));
        start = end;
    }
    return result;
}

std::optional<double> TableReader::number(std::string_view word, std::string_view name) {
    const bool plus = word.starts_with('+') && !word.starts_with("+-");
    const std::string_view digits = word.substr(plus ? 1 : 0);
    const char* const end = digits.data() + digits.size();
    double value = 0;
    const auto [rest, error] = std::from_chars(digits.data(), end, value);
    const bool outOfRange = error == std::errc::result_out_of_range;
    if (rest != end || (error != std::errc() && !outOfRange)) {
        refuse(word, fmt::format("{} is {}, must be a number", name, shown(word)));
        return std::nullopt;
    }
    if (outOfRange) {
        if (std::isfinite(std::strtod(std::string(digits).c_str(), nullptr))) return 0;
        refuse(word, fmt::format("{} is {}, which is too large; must be -1.7e308 to 1.7e308", name, shown(word)));
        return std::nullopt;
    }
    if (std::isfinite(value)) return value;
    refuse(word, fmt::format("{} is {}, must be a finite number", name, value));
    return std::nullopt;
}

std::optional<std::uint64_t> TableReader::whole(std::string_view word, std::string_view name) {
    constexpr std::uint64_t most = 1ULL << 53U;
    std::uint64_t value = 0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc() && rest == word.data() + word.size() && value <= most) return value;
    refuse(word, fmt::format("{} is {}, must be a whole number of at least 0", name, shown(word)));
    return std::nullopt;
}

}  // namespace spherule::scene

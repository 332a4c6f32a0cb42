#include "compute/source.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>

#include <spdlog/fmt/fmt.h>

namespace spherule::compute {
namespace {

constexpr std::size_t linesPerFile = 100000;

constexpr std::string_view bufferKeyword = "BUFFER(";

// True of the line that begins the body of a kernel with a work group for each bundle.
bool definesGroups(std::string_view line) {
    if (line.starts_with("LANE_")) line.remove_prefix(5);
    return line.starts_with("BUNDLE_KERNEL") || line.starts_with("PAIR_KERNEL");
}

// The parts of a line `BUFFER(access, type, name) rest`; parseBuffer() returns nullopt if the line does not have this
// form.
struct BufferLine {
    std::string access, type, name, rest;
};
std::optional<BufferLine> parseBuffer(std::string_view line) {
    const auto isName = [](std::string_view text) {
        const auto inName = [](char c) { return (std::isalnum(static_cast<unsigned char>(c)) != 0) || c == '_'; };
        return !text.empty() && std::ranges::all_of(text, inName);
    };
    const auto end = line.find(')');
    if (end == std::string_view::npos) return std::nullopt;
    std::string_view list = line.substr(bufferKeyword.size(), end - bufferKeyword.size());
    std::array<std::string_view, 3> parts;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const auto comma = list.find(", ");
        if ((comma == std::string_view::npos) != (k + 1 == parts.size())) return std::nullopt;
        parts[k] = list.substr(0, comma);
        if (!isName(parts[k])) return std::nullopt;
        if (comma != std::string_view::npos) list.remove_prefix(comma + 2);
    }
    return BufferLine{std::string(parts[0]), std::string(parts[1]), std::string(parts[2]),
                      std::string(line.substr(end + 1))};
}

// Returns the name in `#include "name"`; nullopt if the line is not such a directive.
std::optional<std::string_view> includedName(std::string_view line) {
    constexpr std::string_view blank = " \t";
    const auto skipBlank = [&] { line.remove_prefix(std::min(line.find_first_not_of(blank), line.size())); };
    const auto skip = [&](std::string_view word) {
        if (!line.starts_with(word)) return false;
        line.remove_prefix(word.size());
        skipBlank();
        return true;
    };
    skipBlank();
    if (!skip("#") || !skip("include") || !line.starts_with('"')) return std::nullopt;
    line.remove_prefix(1);
    const auto end = line.find('"');
    if (end == std::string_view::npos) return std::nullopt;
    return line.substr(0, end);
}

std::optional<std::size_t> takeNumber(std::string_view& text) {
    std::size_t number = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
    if (parsed.ec != std::errc()) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(parsed.ptr - text.data()));
    return number;
}

// Returns the N of "1:N", "1(N)" or "ERROR: 1:N", and sets `message` to the text behind it. Returns nullopt and leaves
// `message` unchanged if it begins differently.
std::optional<std::size_t> takeLineNumber(std::string_view& message) {
    auto rest = message;
    for (const std::string_view kind : {"ERROR: ", "WARNING: "}) {
        if (rest.starts_with(kind)) rest.remove_prefix(kind.size());
    }
    if (!takeNumber(rest) || !(rest.starts_with(':') || rest.starts_with('('))) return std::nullopt;
    const bool bracketed = rest.starts_with('(');
    rest.remove_prefix(1);
    const auto number = takeNumber(rest);
    if (!number) return std::nullopt;
    if (bracketed && rest.starts_with(')')) rest.remove_prefix(1);
    message = rest;
    return number;
}

class Expander {
  public:
    explicit Expander(const SourceSet& sources) : sources_(sources) {}

    // `from`: file and line of the directive, for errors.
    Result<void> append(std::string_view file, const std::string& from) {
        if (std::find(open_.begin(), open_.end(), file) != open_.end()) {
            return fail(ErrorKind::Input, from,
                        fmt::format("\"{}\" includes itself by way of {}", file, fmt::join(open_, " -> ")));
        }
        const auto text = sources_.find(file);
        if (!text) {
            return fail(ErrorKind::Input, from, fmt::format("there is no kernel source \"{}\"; check its name", file));
        }
        open_.emplace_back(file);
        auto result = appendLines(file, *text, indexOf(file));
        open_.pop_back();
        return result;
    }

    ExpandedSource take() { return std::move(result_); }
    ExpandedSource& result() { return result_; }

  private:
    Result<void> appendLines(std::string_view file, std::string_view text, std::size_t index) {
        markLine(1, index);
        std::size_t number = 1;
        for (; !text.empty(); ++number) {
            const auto end = std::min(text.find('\n'), text.size());
            const auto line = text.substr(0, end);
            if (const auto name = includedName(line)) {
                if (auto included = append(*name, fmt::format("{}:{}", file, number)); !included) return included;
                markLine(number + 1, index);
            } else if (line.starts_with(bufferKeyword)) {
                if (auto declared = declareBuffer(line, fmt::format("{}:{}", file, number)); !declared) return declared;
            } else {
                result_.countsGroups = result_.countsGroups || definesGroups(line);
                result_.text.append(line);
                result_.text.push_back('\n');
            }
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        return {};
    }

    Result<void> declareBuffer(std::string_view line, const std::string& where) {
        const auto declared = parseBuffer(line);
        if (!declared) return fail(ErrorKind::Input, where, "is not of the form BUFFER(access, type, name)");
        auto& buffers = result_.buffers;
        if (std::ranges::any_of(buffers, [&](const auto& other) { return other.name == declared->name; }))
            return fail(ErrorKind::Input, where, fmt::format("declares the buffer {} a second time", declared->name));
        if (buffers.size() == maxKernelBuffers)
            return fail(ErrorKind::Input, where,
                        fmt::format("declares {} as buffer {} of its kernel; a kernel has at most {}", declared->name,
                                    buffers.size() + 1, maxKernelBuffers));
        result_.text +=
            fmt::format("layout(std430, binding = {}) {} buffer {}Block {{ {} {}[]; }};{}\n", buffers.size(),
                        declared->access, declared->name, declared->type, declared->name, declared->rest);
        buffers.push_back({declared->type, declared->name});
        return {};
    }

    void markLine(std::size_t line, std::size_t index) {
        result_.text += fmt::format("#line {} {}\n", index * linesPerFile + line, index);
    }

    std::size_t indexOf(std::string_view file) {
        const auto found = std::find(result_.files.begin(), result_.files.end(), file);
        if (found != result_.files.end()) return static_cast<std::size_t>(found - result_.files.begin());
        result_.files.emplace_back(file);
        return result_.files.size() - 1;
    }

    const SourceSet& sources_;
    ExpandedSource result_;
    std::vector<std::string> open_;
};

}  // namespace

Result<ExpandedSource> expandSource(const SourceSet& sources, std::string_view file, std::span<const Define> defines) {
    Expander expander(sources);
    auto& begun = expander.result();
    begun.files.emplace_back("<defines>");
    begun.text = "#version 450 core\n#line 1 0\n";
    for (const auto& define : defines) begun.text += fmt::format("#define {} {}\n", define.name, define.value);
    if (auto appended = expander.append(file, ""); !appended) return tl::unexpected(appended.error());
    return expander.take();
}

std::string nameFiles(std::string_view compilerLog, std::span<const std::string> files) {
    std::string named;
    while (!compilerLog.empty()) {
        const auto end = std::min(compilerLog.find('\n'), compilerLog.size());
        const auto line = compilerLog.substr(0, end);
        compilerLog.remove_prefix(std::min(end + 1, compilerLog.size()));
        auto message = line;
        const auto number = takeLineNumber(message).value_or(0);
        if (const auto index = number / linesPerFile; number > 0 && index < files.size()) {
            named += fmt::format("{}:{}{}\n", files[index], number % linesPerFile, message);
        } else {
            named += fmt::format("{}\n", line);
        }
    }
    return named;
}

}  // namespace spherule::compute

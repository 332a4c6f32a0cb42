#include "core/suggestion.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace spherule {

namespace {

// Returns the text in lower case without '_' and '-'.
std::string plain(std::string_view text) {
    std::string result;
    for (const char c : text)
        if (c != '_' && c != '-') result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

// Edit distance: number of characters to insert, remove or replace, and of neighbours to swap. No character is edited
// twice.
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> beforeLast(b.size() + 1);
    std::vector<std::size_t> last(b.size() + 1);
    std::iota(last.begin(), last.end(), 0U);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::vector<std::size_t> row(b.size() + 1, i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], beforeLast[j - 2] + 1);
        }
        beforeLast = std::exchange(last, std::move(row));
    }
    return last.back();
}

// Returns how many characters both begin with; 0 if these are too few to tell that the same is meant.
std::size_t commonBeginning(std::string_view a, std::string_view b) {
    constexpr std::size_t fewest = 5;
    constexpr std::size_t fewestOfWhole = 4;
    const auto common = static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
    const bool whole = common == std::min(a.size(), b.size());
    return common >= (whole ? fewestOfWhole : fewest) ? common : 0;
}

}  // namespace

std::optional<std::string> suggestionFor(std::string_view word, std::span<const std::string> names) {
    constexpr std::size_t longest = 100;  // of a word that is compared
    const std::string wanted = plain(word.substr(0, longest + 1));
    if (wanted.empty() || word.size() > longest || names.empty()) return std::nullopt;
    const auto distanceTo = [&](const std::string& name) { return distance(wanted, plain(name)); };
    const auto nearest = std::ranges::min_element(names, {}, distanceTo);
    const std::size_t farthest = std::min(std::max<std::size_t>(2, wanted.size() / 3), wanted.size() - 1);
    if (distanceTo(*nearest) <= farthest) return *nearest;
    const auto commonWith = [&](const std::string& name) { return commonBeginning(wanted, plain(name)); };
    const auto likest = std::ranges::max_element(names, {}, commonWith);
    return commonWith(*likest) > 0 ? std::optional(*likest) : std::nullopt;
}

std::string didYouMean(std::string_view word, std::span<const std::string> names) {
    const auto nearest = suggestionFor(word, names);
    return nearest ? fmt::format("; did you mean \"{}\"?", *nearest) : "";
}

}  // namespace spherule

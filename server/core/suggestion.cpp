#include "core/suggestion.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace spherule {

namespace {

// Edit distance: number of characters to insert, remove or replace.
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0U);
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t same = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = std::exchange(row[j + 1], std::min({row[j] + 1, row[j + 1] + 1, same}));
        }
    }
    return row.back();
}

}  // namespace

std::optional<std::string> suggestionFor(std::string_view word, std::span<const std::string> names) {
    constexpr std::size_t farthest = 2;
    constexpr std::size_t longest = 100;  // of a word that is compared
    if (word.empty() || word.size() > longest) return std::nullopt;
    const auto nearest =
        std::ranges::min_element(names, {}, [&](const std::string& name) { return distance(word, name); });
    if (nearest == names.end() || distance(word, *nearest) > std::min(farthest, word.size() - 1)) return std::nullopt;
    return *nearest;
}

}  // namespace spherule

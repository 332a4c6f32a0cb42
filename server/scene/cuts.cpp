#include "scene/cuts.h"

#include <algorithm>
#include <utility>

namespace spherule::scene {

namespace {

constexpr std::string_view blanks = " \t\r\n";

// Removes a comma and blanks around it from the end. Returns false if there is no comma.
bool dropComma(std::string& text) {
    while (!text.empty() && blanks.find(text.back()) != std::string_view::npos) text.pop_back();
    if (!text.ends_with(',')) return false;
    text.pop_back();
    return true;
}

// Returns the offset behind the comma that follows `from`, or `from` if none does.
std::size_t behindComma(std::string_view text, std::size_t from) {
    const std::size_t next = text.find_first_not_of(blanks, from);
    return next != std::string_view::npos && text[next] == ',' ? next + 1 : from;
}

}  // namespace

std::string withoutCuts(std::string_view text, std::vector<Cut> cuts) {
    std::ranges::sort(cuts,
                      [](const Cut& a, const Cut& b) { return std::pair(a.begin, b.end) < std::pair(b.begin, a.end); });
    std::string kept;
    kept.reserve(text.size());
    std::size_t at = 0;
    for (const Cut& cut : cuts) {
        if (cut.begin < at) continue;  // it is within the one before
        kept += text.substr(at, cut.begin - at);
        at = cut.end;
        if (cut.isEntry)
            kept += "{}";
        else if (!dropComma(kept))
            at = behindComma(text, at);
    }
    return kept += text.substr(at);
}

}  // namespace spherule::scene

#include "net/text.h"

#include <algorithm>
#include <cstddef>

namespace spherule::net {

namespace {

constexpr std::size_t longestName = 64;
constexpr std::size_t longestReason = 123;

bool continuesCharacter(char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

}  // namespace

std::string printable(std::string_view text) {
    std::string line(text.substr(0, longestName));
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return line;
}

std::string closeReason(std::string_view reason) {
    if (reason.size() <= longestReason) return std::string(reason);
    std::size_t end = longestReason;
    while (end > 0 && continuesCharacter(reason[end])) --end;
    return std::string(reason.substr(0, end));
}

}  // namespace spherule::net

#include "net/sanitize.h"

#include <algorithm>
#include <cstddef>

#include "core/text.h"

namespace spherule::net {

namespace {

constexpr std::size_t longestName = 64;
constexpr std::size_t longestReason = 123;

}  // namespace

std::string sanitize(std::string_view text) {
    std::string line(text.substr(0, longestName));
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return line;
}

std::string closeReason(std::string_view reason) {
    return std::string(cutUtf8(utf8(reason), longestReason));
}

}  // namespace spherule::net

#include "core/quantity.h"

#include <charconv>
#include <cmath>

namespace spherule {

std::optional<Quantity> quantityOf(std::string_view words) {
    Quantity read;
    const char* const end = words.data() + words.size();
    const auto [unit, error] = std::from_chars(words.data(), end, read.number);
    if (error != std::errc() || !std::isfinite(read.number)) return std::nullopt;
    read.unit = std::string_view(unit, end);
    return read;
}

}  // namespace spherule

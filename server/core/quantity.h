#pragma once

#include <optional>
#include <string_view>

namespace spherule {

// A number and what stands behind it: "16ms", "0.5%", "3".
struct Quantity {
    double number = 0;
    std::string_view unit{};  // into the words it was read from
};

// Nothing where no finite number comes first.
std::optional<Quantity> quantityOf(std::string_view words);

}  // namespace spherule

#pragma once

#include <optional>
#include <string_view>

namespace spherule {

// A number and its unit: "16ms", "0.5%", "3".
struct Quantity {
    double number = 0;
    std::string_view unit{};  // refers to the parsed text
};

// nullopt if the text does not begin with a finite number. Any thread.
std::optional<Quantity> quantityOf(std::string_view words);

}  // namespace spherule

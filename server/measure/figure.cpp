#include "measure/figure.h"

#include <cmath>

namespace spherule::measure {

Figure against(std::string name, double value, double expected, std::string unit, double scale) {
    const double over = scale != 0 ? scale : std::abs(expected);
    return {.name = std::move(name),
            .value = value,
            .expected = expected,
            .error = std::abs(value - expected) / over,
            .unit = std::move(unit)};
}

Figure plain(std::string name, double value, std::string unit) {
    return {.name = std::move(name), .value = value, .unit = std::move(unit)};
}

}  // namespace spherule::measure

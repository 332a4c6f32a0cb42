#include "app/duration.h"

#include <cmath>

#include "core/quantity.h"

namespace spherule::app {

Result<double> secondsOf(const std::string& text, const std::string& option) {
    const auto [number, unit] = quantityOf(text).value_or(Quantity{.number = -1});
    double scale = 0;
    if (unit.empty() || unit == "s") scale = 1;
    if (unit == "ms") scale = 1e-3;
    if (unit == "min") scale = 60;
    if (scale == 0 || number < 0 || !std::isfinite(number * scale))
        return fail(ErrorKind::Input, option, "is \"" + text + "\"; give a time such as 2s, 250ms or 1.5min");
    return number * scale;
}

}  // namespace spherule::app

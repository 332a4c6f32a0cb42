#include "app/duration.h"

#include <charconv>
#include <cmath>

namespace spherule::app {

Result<double> secondsOf(const std::string& text, const std::string& option) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    const std::string unit(rest, end);
    double scale = 0;
    if (unit.empty() || unit == "s") scale = 1;
    if (unit == "ms") scale = 1e-3;
    if (unit == "min") scale = 60;
    if (error != std::errc() || scale == 0 || !std::isfinite(value) || value < 0)
        return fail(ErrorKind::Input, option, "is \"" + text + "\"; give a time such as 2s, 250ms or 1.5min");
    return value * scale;
}

}  // namespace spherule::app

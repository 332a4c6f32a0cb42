#include "cli/option_values.h"

#include <charconv>
#include <cmath>

#include "core/quantity.h"

namespace spherule::cli {

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

Result<Endpoint> endpointOf(const std::string& text) {
    const auto colon = text.rfind(':');
    Endpoint endpoint;
    if (colon != std::string::npos) {
        endpoint.host = text.substr(0, colon);
        const char* end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data() + colon + 1, end, endpoint.port);
        if (endpoint.host.size() > 2 && endpoint.host.front() == '[' && endpoint.host.back() == ']')
            endpoint.host = endpoint.host.substr(1, endpoint.host.size() - 2);
        if (error == std::errc() && rest == end && !endpoint.host.empty()) return endpoint;
    }
    return fail(ErrorKind::Input, "--listen", "is \"" + text + "\"; give host:port, such as 127.0.0.1:8080");
}

}  // namespace spherule::cli

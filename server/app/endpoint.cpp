#include "app/endpoint.h"

#include <charconv>

namespace spherule::app {

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

}  // namespace spherule::app

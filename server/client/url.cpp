#include "client/url.h"

#include <string_view>

namespace spherule::client {

Result<Url> parseUrl(const std::string& url) {
    const auto refuse = [&](const std::string& why) {
        return fail(ErrorKind::Input, url, why + "; expected ws://host:port/ws, or wss:// for TLS");
    };
    const bool secure = url.starts_with("wss://");
    if (!secure && !url.starts_with("ws://")) return refuse("does not begin with ws:// or wss://");
    const std::string_view scheme = secure ? "wss://" : "ws://";
    const std::size_t slash = url.find('/', scheme.size());
    std::string authority = url.substr(scheme.size(), slash - scheme.size());
    Url result{.secure = secure,
               .host = "",
               .port = secure ? "443" : "80",
               .path = slash == std::string::npos ? "/ws" : url.substr(slash)};
    const std::size_t colon = authority.rfind(':');
    if (colon != std::string::npos && authority.back() != ']') {
        result.port = authority.substr(colon + 1);
        authority.resize(colon);
    }
    if (authority.size() > 2 && authority.front() == '[' && authority.back() == ']') {
        authority = authority.substr(1, authority.size() - 2);
    }
    if (authority.empty() || result.port.empty()) return refuse("names no host or no port");
    result.host = authority;
    return result;
}

}  // namespace spherule::client

#pragma once

#include <string>

namespace spherule::net {

// Secrets of the server; they may change while it runs. An empty string: not set.
struct Credentials {
    std::string viewerToken{};      // grants the role viewer
    std::string controllerToken{};  // grants the role controller
    std::string certificate{};      // PEM: the server's certificate, then the intermediate ones
    std::string key{};              // PEM: private key of the certificate
};

// Returns true when a client needs a token.
inline bool requiresToken(const Credentials& credentials) {
    return !credentials.viewerToken.empty() || !credentials.controllerToken.empty();
}

}  // namespace spherule::net

#pragma once

#include <string>

namespace spherule::net {

// What nobody else may know; may change while the server runs. Empty: there is none.
struct Credentials {
    std::string viewerToken{};      // lets in to watch
    std::string controllerToken{};  // lets in to watch and to command
    std::string certificate{};      // PEM, the server's own first, then those that lead from it to the root
    std::string key{};              // PEM
};

// Whether they keep anybody out.
inline bool requiresToken(const Credentials& credentials) {
    return !credentials.viewerToken.empty() || !credentials.controllerToken.empty();
}

}  // namespace spherule::net

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "net/credentials.h"
#include "spherule/v1/control.pb.h"

namespace spherule::net {

// Host names and origins that the server accepts. Compared as a whole and without regard to case: no patterns.
struct AllowedNames {
    // "name" or "name:port". Localhost and IP addresses are always accepted.
    std::vector<std::string> hosts{};
    // "scheme://name[:port]" of pages that may open the stream. Their hosts are accepted as well.
    std::vector<std::string> origins{};
};

// Input unless `origin` is like "https://spherule.example.org" or "https://spherule.example.org:8443".
Result<void> checkOrigin(const std::string& origin);
// Input unless `host` is like "spherule.example.org" or "spherule.example.org:8443".
Result<void> checkHost(const std::string& host);
// Input unless `token` has 16 to 256 printable ASCII characters without spaces. `where`: source of the token, for the
// error.
Result<void> checkToken(const std::string& token, const std::string& where);

// Decides which requests are accepted, and which role a token grants. Immutable: any thread.
class Admission {
  public:
    // `scheme`: http or https, of this server.
    Admission(AllowedNames allowedNames, Credentials credentials, std::string scheme);

    // Returns true when this Host header names this server. Protects against DNS rebinding: a foreign page whose name
    // resolves to this server sends its own name.
    [[nodiscard]] bool isHost(std::string_view host) const;
    // Returns true when a page of this origin may open the stream: a page of this server, or a listed origin. `host`:
    // the Host header, for which isHost() is true.
    [[nodiscard]] bool isOrigin(std::string_view origin, std::string_view host) const;

    // Without tokens every client is a controller.
    [[nodiscard]] bool asksForToken() const { return !viewerToken_.empty() || !controllerToken_.empty(); }
    // nullopt if the token is unknown. The time does not depend on how much of the token is right.
    [[nodiscard]] std::optional<v1::Role> roleOf(std::string_view token) const;

  private:
    AllowedNames allowed_;  // lower case
    std::string viewerToken_, controllerToken_;
    std::string scheme_;
};

}  // namespace spherule::net

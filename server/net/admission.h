#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "net/credentials.h"
#include "spherule/v1/control.pb.h"

namespace spherule::net {

// Which names a server goes by. What is listed is compared as a whole, without regard to case: no patterns, no endings.
struct AllowedNames {
    std::vector<std::string>
        hosts{};  // "name" or "name:port", beside localhost and addresses, which need no name server
    std::vector<std::string>
        origins{};  // "scheme://name[:port]", whose pages may open the stream; their hosts are taken too
};

// Such as "https://spherule.example.org" or with ":8443"; anything more is an error.
Result<void> checkOrigin(const std::string& origin);
// Such as "spherule.example.org" or with ":8443".
Result<void> checkHost(const std::string& host);
// What can be guessed, or cannot be typed, is no token. `where`: where it came from.
Result<void> checkToken(const std::string& token, const std::string& where);

// Who may come in, and as what. A value: any thread.
class Admission {
  public:
    // `scheme`: http or https, which this server speaks.
    Admission(AllowedNames allowedNames, Credentials credentials, std::string scheme);

    // Whether a request with this Host header means this server. A page of somebody else's whose name leads here (DNS
    // rebinding) has its own name there.
    [[nodiscard]] bool isHost(std::string_view host) const;
    // Whether a page of this origin may open the stream: one of this server's own, or one that is listed. `host`: that
    // of the request, which isHost().
    [[nodiscard]] bool isOrigin(std::string_view origin, std::string_view host) const;

    // Without tokens, everybody is let in, and is a controller.
    [[nodiscard]] bool asksForToken() const { return !viewerToken_.empty() || !controllerToken_.empty(); }
    // Nothing: not let in. Takes as long for a token that is nearly right as for another of its length.
    [[nodiscard]] std::optional<v1::Role> roleOf(std::string_view token) const;

  private:
    AllowedNames allowed_;  // lower case
    std::string viewerToken_, controllerToken_;
    std::string scheme_;
};

}  // namespace spherule::net

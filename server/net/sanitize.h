#pragma once

#include <string>
#include <string_view>

namespace spherule::net {

// Returns at most 64 characters of a client's text for one log line. Replaces each byte that is not printable ASCII by
// '?'.
std::string sanitize(std::string_view text);

// Returns valid UTF-8 of at most 123 bytes, the limit of a WebSocket close frame.
std::string closeReason(std::string_view reason);

}  // namespace spherule::net

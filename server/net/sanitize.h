#pragma once

#include <string>
#include <string_view>

namespace spherule::net {

// What a stranger sent, made fit for one line of the log.
std::string sanitize(std::string_view text);

// Valid UTF-8, cut between characters to the 123 bytes that a close frame holds.
std::string closeReason(std::string_view reason);

}  // namespace spherule::net

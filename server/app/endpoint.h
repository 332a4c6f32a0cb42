#pragma once

#include <cstdint>
#include <string>

#include "core/result.h"

namespace spherule::app {

struct Endpoint {
    std::string host;
    std::uint16_t port = 0;
};

// Parses "host:port", with an IPv6 address in brackets.
Result<Endpoint> endpointOf(const std::string& text);

}  // namespace spherule::app

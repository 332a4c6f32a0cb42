#pragma once

#include <cstdint>
#include <string>

#include "core/result.h"

// Values of options on the command line.
namespace spherule::cli {

// Parses "2s", "250ms", "1.5min" or plain seconds. `option`: the name in the error.
Result<double> secondsOf(const std::string& text, const std::string& option);

struct Endpoint {
    std::string host;
    std::uint16_t port = 0;
};

// Parses "host:port", with an IPv6 address in brackets.
Result<Endpoint> endpointOf(const std::string& text);

}  // namespace spherule::cli

#pragma once

#include <string>

#include "core/result.h"

namespace spherule::client {

struct Url {
    bool secure = false;
    std::string host;
    std::string port;
    std::string path;
};

// Parses ws://host[:port][/path], or wss:// for TLS. Default port 80 or 443, default path /ws. Input for other text.
Result<Url> parseUrl(const std::string& url);

}  // namespace spherule::client

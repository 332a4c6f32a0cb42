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

// Of ws://host[:port][/path], or wss:// for TLS; port 80, or 443, and path /ws where they are missing.
Result<Url> parseUrl(const std::string& url);

}  // namespace spherule::client

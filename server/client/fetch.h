#pragma once

#include <chrono>
#include <string>

#include "client/url.h"
#include "core/result.h"

namespace spherule::client {

struct Fetched {
    int status = 0;
    std::string body;
};

// Asks for a page and waits for it, at most so long. For who asks about a server on the same machine: its certificate
// is not looked at.
Result<Fetched> fetch(const Url& url, std::chrono::milliseconds timeout);

}  // namespace spherule::client

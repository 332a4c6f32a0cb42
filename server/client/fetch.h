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

// Sends GET and waits up to `timeout` for the answer. Does not verify the certificate, so use it only for a server on
// this machine. Refused if there is no answer. Blocks.
Result<Fetched> fetch(const Url& url, std::chrono::milliseconds timeout);

}  // namespace spherule::client

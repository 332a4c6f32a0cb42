#pragma once

#include <spdlog/spdlog.h>

namespace spherule {

// Sends the program's log to stderr, so that stdout stays free for results. Call once, from main.
void startLog(bool verbose);

}  // namespace spherule

#pragma once

#include <string>

#include "app/show.h"

namespace spherule::app {

// Serves a show on "host:port" until it fails or the program is told to stop (SIGINT, SIGTERM), and gives the exit
// code. `watchdog`: see addWatchdog. `what` is said of it at the beginning, such as "serves".
int serveUntilStopped(const OpenShow& open, const std::string& listen, double watchdog, const std::string& what);

}  // namespace spherule::app

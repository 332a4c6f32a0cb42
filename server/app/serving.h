#pragma once

#include <string>

#include "app/serving_options.h"
#include "app/show.h"

namespace spherule::app {

// Serves a show until it fails or the program is told to stop (SIGINT, SIGTERM), and gives the exit code. SIGHUP reads
// tokens and certificate anew. `what` is said of the show at the beginning, such as "serves".
int serveUntilStopped(const OpenShow& open, const ServingOptions& options, const std::string& what);

}  // namespace spherule::app

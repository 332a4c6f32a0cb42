#pragma once

#include <string>

#include "app/serving_options.h"
#include "app/show.h"

namespace spherule::app {

// Serves a show until it fails, or until SIGINT or SIGTERM. Returns the exit code. SIGHUP reads tokens and certificate
// again. `what` introduces the show at the start, such as "serves".
int serveUntilStopped(const OpenShow& open, const ServingOptions& options, const std::string& what);

}  // namespace spherule::app

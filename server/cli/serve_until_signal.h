#pragma once

#include <string>

#include "cli/server_options.h"
#include "host/frame_producer.h"

namespace spherule::cli {

// Serves the frames of a producer until it fails, or until SIGINT or SIGTERM. Returns the exit code. SIGHUP reads
// tokens and certificate again. `what` introduces the line at the start, such as "serves".
int serveUntilSignal(const host::ProducerFactory& create, const ServerOptions& options, const std::string& what);

}  // namespace spherule::cli

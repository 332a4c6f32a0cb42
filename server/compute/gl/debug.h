#pragma once

namespace spherule::compute::gl {

#ifdef NDEBUG
constexpr bool debugBuild = false;
#else
constexpr bool debugBuild = true;
#endif

// Sends the driver's messages about the current context to the log: errors as errors, hints at debug level.
void logDriverMessages();

}  // namespace spherule::compute::gl

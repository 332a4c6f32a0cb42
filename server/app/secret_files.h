#pragma once

#include <string>

#include "core/result.h"

namespace spherule::app {

// What the file of an option has in it; empty without a file. One that is empty, too long or cannot be read is an
// error.
Result<std::string> contentOf(const std::string& option, const std::string& path);

// A token, of the option's file or of an environment variable; empty where neither is given. Never of the command line,
// where other users of the machine would see it.
Result<std::string> tokenOf(const std::string& option, const std::string& path, const char* variable);

}  // namespace spherule::app

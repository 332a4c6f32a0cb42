#pragma once

#include <string>

#include "core/result.h"

namespace spherule::cli {

// Returns the content of the file of an option; empty if `path` is empty. Input if the file is empty, too long or
// unreadable.
Result<std::string> contentOf(const std::string& option, const std::string& path);

// Returns the token from the option's file or from an environment variable; empty if neither is given. A token is never
// an argument, because other users of the machine can see arguments.
Result<std::string> tokenOf(const std::string& option, const std::string& path, const char* variable);

}  // namespace spherule::cli

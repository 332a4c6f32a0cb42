#pragma once

#include <string>

#include "core/result.h"

namespace spherule::app {

// Parses "2s", "250ms", "1.5min" or plain seconds. `option`: the name in the error.
Result<double> secondsOf(const std::string& text, const std::string& option);

}  // namespace spherule::app

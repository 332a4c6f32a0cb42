#pragma once

#include <string>

#include "measure/report.h"

namespace spherule::measure {

// Returns the summary above the tables: the main errors with their cost, and all failures.
std::string overviewOf(const Report& report);

}  // namespace spherule::measure

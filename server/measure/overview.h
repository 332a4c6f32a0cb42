#pragma once

#include <string>

#include "measure/report.h"

namespace spherule::measure {

// The summary above the tables: headline errors with their cost, and all failures.
std::string overviewOf(const Report& report);

}  // namespace spherule::measure

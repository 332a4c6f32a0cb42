#pragma once

#include <string>

#include "measure/report.h"

namespace spherule::measure {

// What a reader of the tables should see first: headline errors with their cost, and everything that fails.
std::string overviewOf(const Report& report);

}  // namespace spherule::measure

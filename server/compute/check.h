#pragma once

#include <string>

namespace spherule::compute {

// A mistake of ours that would compute wrong results: logged, then the program ends.
[[noreturn]] void programError(const std::string& message);

}  // namespace spherule::compute

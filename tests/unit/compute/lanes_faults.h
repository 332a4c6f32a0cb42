#pragma once

// The first operation on 4, 8 or 16 lanes that differs from the operation on single values; null if there is none.
namespace spherule::compute::cpu {

namespace lanes4 {
const char* firstFault();
}
namespace lanes8 {
const char* firstFault();
}
namespace lanes16 {
const char* firstFault();
}

}  // namespace spherule::compute::cpu

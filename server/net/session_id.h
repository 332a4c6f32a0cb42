#pragma once

#include <cstdint>

namespace spherule::net {

// Numbers the sessions of one server, from 1 on; 0 names no session.
using SessionId = std::uint64_t;

}  // namespace spherule::net

#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "net/decode.h"

namespace spherule::net {

// Facts about a message that are known before it is parsed.
struct Preview {
    bool command = false;  // the message is a command
    std::uint64_t id = 0;  // of the command; 0: unknown
    // Upper estimate of the memory for parsing the message (bytes). A nested message takes 100 to 200 bytes, however
    // short it is on the wire.
    std::size_t cost = 0;
};

// Scans the bytes once and stops when the cost exceeds `most` (bytes). Any thread. Time is linear in the size.
Preview previewOf(std::string_view bytes, Encoding encoding, std::size_t most);

}  // namespace spherule::net

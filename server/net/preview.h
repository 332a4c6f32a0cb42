#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "net/decode.h"

namespace spherule::net {

// What one look over the bytes of a message tells before it is parsed.
struct Preview {
    bool command = false;
    std::uint64_t id = 0;  // of the command; 0: unknown
    // Bytes of memory that the parsed message and its parser take, estimated from above: some 100 to 200 for a message
    // within it, however few bytes it has on the wire.
    std::size_t cost = 0;
};

// Looks no further once the cost is above `most`. Time: linear in the bytes.
Preview previewOf(std::string_view bytes, Encoding encoding, std::size_t most);

}  // namespace spherule::net

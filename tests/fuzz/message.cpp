// Fuzzes the decoder of client messages. The first byte selects a binary or a text frame.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "net/preview.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace spherule;
    if (size == 0) return 0;
    const std::string_view bytes(reinterpret_cast<const char*>(data + 1), size - 1);
    const auto encoding = (data[0] & 1U) != 0 ? net::Encoding::Text : net::Encoding::Binary;
    (void)net::previewOf(bytes, encoding, std::size_t{16} << 20U);
    (void)net::decodeClientMessage(bytes, encoding);
    return 0;
}

// Fuzzes Decoder with a chain of frames: two bytes with the number of spheres, then frames, each after two bytes with
// its length.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "codec/decoder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace spherule;
    constexpr std::uint32_t mostSpheres = 20'000;
    const auto number = [&](std::size_t at) { return data[at] + 256U * data[at + 1]; };
    if (size < 2) return 0;
    codec::Decoder decoder(std::clamp(number(0), 1U, mostSpheres));
    for (std::size_t at = 2; at + 2 <= size;) {
        const std::size_t length = std::min<std::size_t>(number(at), size - at - 2);
        const auto head = decoder.apply(std::as_bytes(std::span(data + at + 2, length)));
        if (head && decoder.wantsKeyframe()) std::abort();
        at += 2 + length;
    }
    return 0;
}

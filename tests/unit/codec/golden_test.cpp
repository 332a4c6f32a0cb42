// The frames in tests/golden/codec: the encoder makes them, and the decoder reads them. Tests of the page read them
// too. SPHERULE_WRITE_GOLDEN=1 writes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include "codec/decoder.h"
#include "codec_support.h"

namespace spherule::codec {
namespace {

constexpr std::uint32_t spheres = 9 * 64 + 7;

std::string pathOf(const std::string& name) {
    return SPHERULE_GOLDEN "/codec/" + name;
}

Bytes read(const std::string& name) {
    std::ifstream file(pathOf(name), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

void write(const std::string& name, std::span<const std::byte> bytes) {
    std::ofstream file(pathOf(name), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

const bool writing = std::getenv("SPHERULE_WRITE_GOLDEN") != nullptr;

// The frame is unchanged, and the decoder accepts it.
void compare(const std::string& name, const Bytes& made, codec::Decoder& decoder) {
    if (writing) write(name, made);
    const Bytes golden = read(name);
    EXPECT_TRUE(made == golden) << name;
    const auto head = decoder.apply(golden);
    ASSERT_TRUE(head) << name << ": " << head.error().text();
    EXPECT_TRUE(head->hash);
}

TEST(CodecGolden, FramesAreUnchanged) {
    Encoder encoder("cpu:1", spheres);
    Motion motion(spheres, 2);
    codec::Decoder decoder(spheres);
    for (int k = 0; k < 8; ++k) {
        // A new viewer starts with frame 5, a keyframe of the state after frame 4.
        const Bytes made = k == 0   ? encoder.begin(positionsAt(motion.next()))
                           : k == 5 ? encoder.join()
                                    : encoder.next(positionsAt(motion.next()));
        compare("frame-" + std::to_string(k) + ".spb", made, decoder);
    }
    if (writing) write("positions.i32", std::as_bytes(decoder.newest()));
    const Bytes positions = read("positions.i32");
    ASSERT_EQ(positions.size(), spheres * sizeof(glm::ivec3));
    EXPECT_EQ(std::memcmp(positions.data(), decoder.newest().data(), positions.size()), 0);
}

// The example of docs/codec.md: two chunks; the second has two groups; the last group has one block with one sphere.
// Blocks are apart and move as a whole, one of 16 at a time, so that the files are small.
std::vector<glm::ivec3> crowd(int frame) {
    std::vector<glm::ivec3> cells;
    for (int k = 0; k < 16384 + 2048 + 1; ++k) {
        const int block = k / 64;
        const int moved = (frame + block % 16) / 16;
        cells.emplace_back(100 * block + k % 2 * (1 << block % 13), moved * (5 + block % 7) - block,
                           7 - k % 3 * (moved % 2));
    }
    return cells;
}

TEST(CodecGolden, FramesOfSeveralChunksAreUnchanged) {
    const auto count = static_cast<std::uint32_t>(crowd(0).size());
    Encoder encoder("cpu:1", count);
    codec::Decoder decoder(count);
    for (int k = 0; k < 4; ++k) {
        const Positions positions = positionsAt(crowd(6 * k));
        compare("chunks-" + std::to_string(k) + ".spb", k == 0 ? encoder.begin(positions) : encoder.next(positions),
                decoder);
        EXPECT_TRUE(std::ranges::equal(decoder.newest(), crowd(6 * k)));
    }
}

}  // namespace
}  // namespace spherule::codec

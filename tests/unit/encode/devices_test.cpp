// The encoder makes the same bytes on the CPU device, with any number of threads, and on Mesa's software renderer.
#include <gtest/gtest.h>

#include <cmath>

#include "codec_support.h"

namespace spherule::codec {
namespace {

std::vector<Bytes> framesOn(const std::string& device) {
    constexpr std::uint32_t spheres = 70001;
    Encoder encoder(device, spheres);
    Motion motion(spheres, 9);
    std::vector<Bytes> frames{encoder.begin(positionsAt(motion.next()))};
    for (int k = 0; k < 12; ++k) {
        frames.push_back(encoder.next(positionsAt(motion.next())));
        if (k == 6) frames.push_back(encoder.join());
    }
    return frames;
}

TEST(CodecDevices, ProduceTheSameBytes) {
    const auto wanted = framesOn("software");
    for (const char* const device : {"cpu:1", "cpu:3", "cpu-double"}) {
        const auto got = framesOn(device);
        ASSERT_EQ(got.size(), wanted.size());
        for (std::size_t k = 0; k < got.size(); ++k) EXPECT_TRUE(got[k] == wanted[k]) << device << ", frame " << k;
    }
}

TEST(CodecDevices, ClampNonFinitePositionsAlike) {
    const auto edges = [](const char* device) {
        Encoder encoder(device, 70);
        Positions wild(70, glm::vec4(1, 2, 3, 1));
        wild[3] = glm::vec4(INFINITY, -INFINITY, NAN, 1);
        wild[66] = glm::vec4(-NAN, 3e38F, -3e38F, 1);
        return encoder.begin(wild);
    };
    EXPECT_TRUE(edges("software") == edges("cpu:1"));
}

}  // namespace
}  // namespace spherule::codec

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "kernels_support.h"

namespace spherule::kernels {
namespace {

// Positions outside the bounds by less than one length move back exactly, and the lengths are counted by id.
TEST(KernelsAsCpp, PositionsAreMovedBackExactly) {
    std::mt19937 random(5);
    for (const float length : {1.0F, 0.37F, 2.75F, 1000.0F}) {
        layout::Parameters parameters{};
        parameters.halfLength = vec4(0.5F * length, 0, 0.25F * length, 0);
        parameters.perLength = vec4(1 / length, 0, 2 / length, 0);
        std::uniform_real_distribution<float> place(-0.99F * length, 0.99F * length);
        constexpr uint count = 2000;
        parameters.spheres = count;
        std::vector<vec4> before;
        std::vector<uint> ids;
        for (uint k = 0; k < count; ++k) {
            before.emplace_back(place(random), place(random), 0.5F * place(random), 0.1F);
            ids.push_back(count - 1 - k);
        }
        before[0].x = 0.5F * length;
        before[1].x = -0.5F * length;
        before[2].x = std::numeric_limits<float>::quiet_NaN();
        before[3].z = std::numeric_limits<float>::infinity();
        std::vector<vec4> after = before;
        std::vector<uvec4> images(count, uvec4(0U));
        for (int times = 0; times < 2; ++times)  // the second one changes nothing
            launch("wrap_positions", {{"position", after}, {"idAndMaterial", ids}, {"images", images}},
                   {.parameters = &parameters, .features = allFeatures});
        int moved = 0;
        for (uint k = 0; k < count; ++k) {
            if (k == 2 || k == 3) {
                EXPECT_EQ(images[ids[k]], uvec4(0U));
                continue;
            }
            EXPECT_EQ(after[k].y, before[k].y);
            EXPECT_EQ(after[k].w, before[k].w);
            for (const int axis : {0, 2}) {
                const double period = 2 * static_cast<double>(parameters.halfLength[axis]);
                const auto turns = static_cast<int>(images[ids[k]][axis]);
                EXPECT_EQ(static_cast<double>(after[k][axis]) + turns * period, static_cast<double>(before[k][axis]));
                EXPECT_GE(after[k][axis], -parameters.halfLength[axis]);
                EXPECT_LT(after[k][axis], parameters.halfLength[axis]);
                if (turns != 0) ++moved;
            }
        }
        EXPECT_GT(moved, 500);
    }
}

}  // namespace
}  // namespace spherule::kernels

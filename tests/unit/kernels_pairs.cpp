#include <gtest/gtest.h>

#include <cmath>

#include "kernels_support.h"

namespace spherule::kernels {
namespace {

// Spheres of 0.5 m in cells of 1.1 m, through one rebuild of the lists and one position pass.
struct Bed {
    explicit Bed(std::vector<vec4> positions) : position(std::move(positions)) {
        const std::size_t n = position.size();
        parameters.spheres = static_cast<uint>(n);
        parameters.cells = uvec4(8, 8, 8, 512);
        parameters.groups = 8;
        parameters.inverseCell = 1 / 1.1F;
        parameters.margin = 0.1F;
        parameters.radius = 0.5F;
        parameters.substep = 1 / 480.0F;
        parameters.perSubstep = 480;
        parameters.pairCapacity = 64;
        velocity.assign(n, vec4(0, 0, 0, 1));
        before.assign(n, vec4(0));
        for (uint k = 0; k < n; ++k) id.push_back(k);
    }

    void rebuild() {
        const Launch how{.parameters = &parameters};
        const auto n = position.size();
        std::vector<uint> place(n), order(n), savedId(n);
        std::vector<vec4> saved(3 * n);
        launch("cell_clear", {cellStart}, how);
        launch("cell_count", {position, cellStart, place}, how);
        prefixSum(cellStart);
        launch("cell_scatter", {position, cellStart, place, order}, how);
        launch("cell_order", {cellStart, order, id}, how);
        launch("state_save", {position, velocity, before, id, saved, savedId}, how);
        launch("state_gather", {position, velocity, before, id, saved, savedId, order}, how);
        launch("list_build", {position, cellStart, counters, pairs, span}, how);
    }

    void separate() {
        for (uint colour = 0; colour < 8; ++colour)
            launch("solve_positions", {position, velocity, id, cellStart, span, pairs, touching},
                   {.parameters = &parameters, .phase = colour});
    }

    vec3 at(uint wanted) const {
        for (std::size_t slot = 0; slot < id.size(); ++slot)
            if (id[slot] == wanted) return vec3(position[slot]);
        throw std::out_of_range("id");
    }

    layout::Parameters parameters{};
    std::vector<vec4> position, velocity, before;
    std::vector<uint> id;
    std::vector<uint> cellStart = std::vector<uint>(513);
    std::vector<uint> counters = std::vector<uint>(COUNTER_WORDS);
    std::vector<uvec2> pairs = std::vector<uvec2>(64);
    std::vector<uvec2> touching = std::vector<uvec2>(64);
    std::vector<uvec4> span = std::vector<uvec4>(64);
};

float distance(vec3 a, vec3 b) {
    const vec3 d = a - b;
    return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

TEST(KernelsAsCpp, PairsWithinTheMarginAreListedOnce) {
    // 0-1 overlap, 1-2 are apart by half the margin, 3 is alone; 0-4 meet across a cell border below the origin.
    Bed bed({vec4(0.1F, 0, 0, 0.5F), vec4(1.0F, 0, 0, 0.5F), vec4(2.05F, 0, 0, 0.5F), vec4(0, 5, 0, 0.5F),
             vec4(-0.8F, 0, 0, 0.5F)});
    bed.rebuild();
    EXPECT_EQ(bed.counters[COUNTER_PAIRS], 3U);
    EXPECT_EQ(bed.counters[COUNTER_UNLISTED], 0U);
}

TEST(KernelsAsCpp, AnOverlappingPairIsPushedApartToTouchingTheLighterOneFurther) {
    Bed bed({vec4(0, 0, 0, 0.5F), vec4(0.9F, 0, 0, 0.5F)});
    bed.velocity[1].w = 3;  // inverse mass
    bed.rebuild();
    bed.separate();
    EXPECT_NEAR(bed.at(0).x, -0.025F, 1e-6F);
    EXPECT_NEAR(bed.at(1).x, 0.975F, 1e-6F);
    vec3 momentum(0);
    for (const vec4& v : bed.velocity) momentum += vec3(v) / v.w;
    EXPECT_NEAR(momentum.x, 0, 1e-5F);
    for (const vec4& v : bed.velocity) EXPECT_NEAR(std::abs(v.x), 0.025F * v.w * 480, 1e-3F);
}

TEST(KernelsAsCpp, GroupsWithoutRoomForTheirPairsArePushedApartAllTheSame) {
    Bed bed({vec4(0, 0, 0, 0.5F), vec4(0.9F, 0, 0, 0.5F)});
    bed.parameters.pairCapacity = 0;
    bed.rebuild();
    EXPECT_EQ(bed.counters[COUNTER_UNLISTED], 1U);
    bed.separate();
    EXPECT_NEAR(distance(bed.at(0), bed.at(1)), 1.0F, 1e-6F);
}

}  // namespace
}  // namespace spherule::kernels

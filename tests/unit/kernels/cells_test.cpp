#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "kernels_support.h"

namespace spherule::kernels {
namespace {

// Spheres in cells of 1 m on a torus of 4 x 4 x 4 cells.
struct Cells {
    explicit Cells(std::vector<vec4> positions) : position(std::move(positions)) {
        parameters.spheres = static_cast<uint>(position.size());
        parameters.cells = uvec4(4, 4, 4, 64);
        parameters.inverseCell = 1;
        parameters.levels = 1;
        parameters.levelCells[0] = uvec4(4, 4, 4, 0);
        parameters.levelSize[0] = vec4(1, 0.1F, 0, 0);
        parameters.cellsPerMetre[0] = vec4(1, 1, 1, 0);
        id.resize(position.size());
        std::iota(id.begin(), id.end(), 0U);
        std::shuffle(id.begin(), id.end(), std::mt19937(2));
        start.resize(65);
        place.resize(position.size());
        cells.resize(position.size());
        order.resize(position.size());
    }

    void sort() {
        const Launch how{.parameters = &parameters, .features = allFeatures};
        const Slot slots[] = {{"position", position},  {"cellStart", start}, {"rankInCell", place},
                              {"cellOfSphere", cells}, {"cellOrder", order}, {"idAndMaterial", id},
                              {"counters", counters},  {"moverSlots", order}};
        launch("cell_clear", slots, how);
        launch("cell_count", slots, how);
        prefixSum(start);
        launch("cell_scatter", slots, how);
        const Slot orderSlots[] = {{"cellStart", start},
                                   {"cellOrder", order},
                                   {"otherOrder", place},
                                   {"idAndMaterial", id},
                                   {"counters", counters}};
        launch("cell_order", orderSlots, how);
    }

    std::vector<uint> idsOf(uint cell) const {
        std::vector<uint> ids;
        for (uint k = start[cell]; k < start[cell + 1]; ++k) ids.push_back(id[order[k]]);
        return ids;
    }

    layout::Parameters parameters{};
    std::vector<vec4> position;
    std::vector<uint> id, start, place, cells, order;
    std::vector<uint> counters = std::vector<uint>(COUNTER_WORDS);
};

// Cells that a single thread sorts, and crowds. Ids have all 24 bits, and a material above them.
TEST(KernelsAsCpp, SpheresOfACellAreSortedByIdWhateverTheirNumber) {
    std::mt19937 random(5);
    for (const uint spheres : {2U, 31U, 32U, 33U, 64U, 1000U, 5000U}) {
        Cells cells(std::vector<vec4>(spheres, vec4(0.5F, 0.5F, 0.5F, 0.1F)));
        const uint step = (1U << 24U) / spheres;
        std::vector<uint> wanted;
        for (uint& word : cells.id) {
            word = word * step + static_cast<uint>(random()) % step;
            wanted.push_back(word);
            word |= (static_cast<uint>(random()) % 256U) << 24U;
        }
        std::ranges::sort(wanted);
        cells.sort();
        std::vector<uint> ids = cells.idsOf(0);
        for (uint& id : ids) id &= (1U << 24U) - 1U;
        EXPECT_EQ(ids, wanted) << spheres;
    }
}

TEST(KernelsAsCpp, EverySphereIsInItsPeriodicCell) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> coordinate(-9, 9);
    std::vector<vec4> positions(500);
    for (vec4& p : positions) p = vec4(coordinate(random), coordinate(random), coordinate(random), 0.1F);
    Cells cells(positions);
    cells.sort();
    EXPECT_EQ(cells.start.back(), 500U);
    for (uint cell = 0; cell < 64; ++cell) {
        const auto ids = cells.idsOf(cell);
        EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
        for (uint k = cells.start[cell]; k < cells.start[cell + 1]; ++k) {
            const vec4 p = positions[cells.order[k]];
            const auto wrap = [](float x) { return (static_cast<int>(std::floor(x)) % 4 + 4) % 4; };
            EXPECT_EQ(cell, static_cast<uint>((wrap(p.y) * 4 + wrap(p.z)) * 4 + wrap(p.x)));
        }
    }
}

}  // namespace
}  // namespace spherule::kernels

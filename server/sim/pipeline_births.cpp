// The part of Pipeline that finds places for new spheres.
#include <algorithm>
#include <limits>

#include <glm/common.hpp>

#include "sim/pipeline.h"

namespace spherule::sim {

namespace {

// Writes the rows of a chunk of places, as in layout.h.
void writeChunk(std::span<const glm::vec4> places, std::span<glm::vec4> rows) {
    glm::vec3 low(std::numeric_limits<float>::infinity());
    glm::vec3 high(-std::numeric_limits<float>::infinity());
    for (const glm::vec4& place : places) {
        low = glm::min(low, glm::vec3(place) - place.w);
        high = glm::max(high, glm::vec3(place) + place.w);
    }
    constexpr float rounding = 1e-5F;
    const glm::vec3 centre = 0.5F * (low + high);
    rows[0] = glm::vec4(centre, 0);
    rows[1] = glm::vec4((1 + rounding) * glm::max(high - centre, centre - low), 0);
    std::ranges::copy(places, rows.begin() + 2);
}

}  // namespace

Result<void> Pipeline::makeBirths() {
    if (!births_.empty()) return {};
    constexpr std::uint64_t chunks = MOST_BIRTH_PLACES / BIRTH_CHUNK;
    if (auto made = makeMissing(Array::BirthPlaces, chunks * BIRTH_CHUNK_ROWS); !made) return made;
    if (auto made = makeMissing(Array::BirthTaken, MOST_BIRTH_PLACES); !made) return made;
    return bindLate(plan_.births, births_);
}

std::vector<bool> Pipeline::takenPlaces(std::span<const glm::vec4> places) {
    if (places.empty() || plan_.spheres == 0) return std::vector<bool>(places.size());
    const std::uint32_t chunks = blocksOf(static_cast<std::uint32_t>(places.size()), BIRTH_CHUNK);
    std::vector<glm::vec4> rows(std::size_t{chunks} * BIRTH_CHUNK_ROWS);
    for (std::size_t k = 0; k < chunks; ++k)
        writeChunk(places.subspan(k * BIRTH_CHUNK, std::min<std::size_t>(BIRTH_CHUNK, places.size() - k * BIRTH_CHUNK)),
                   std::span(rows).subspan(k * BIRTH_CHUNK_ROWS, BIRTH_CHUNK_ROWS));
    write<glm::vec4>(Array::BirthPlaces, rows);
    device_.fill(buffer(Array::BirthTaken), 0);
    plan_.births.front().phase = chunks;
    run(births_, LaunchSet::Substep);
    const auto words = read<std::uint32_t>(Array::BirthTaken, places.size());
    std::vector<bool> taken;
    for (const std::uint32_t word : words) taken.push_back(word != 0);
    return taken;
}

}  // namespace spherule::sim

// The part of Simulation that lets emitters make spheres.
#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scene/load.h"
#include "scene/occupancy.h"
#include "scene/surroundings.h"
#include "sim/memory_needs.h"
#include "sim/preparation.h"
#include "sim/simulation.h"

namespace spherule::sim {

namespace {

// Moves a position into the bounds along periodic axes.
void wrap(glm::dvec3& position, const scene::Bounds& bounds) {
    const glm::dvec3 periods = bounds.periods();
    for (int axis = 0; axis < 3; ++axis)
        if (periods[axis] > 0)
            position[axis] -= periods[axis] * std::floor((position[axis] - bounds.min[axis]) / periods[axis]);
}

}  // namespace

// Makes the spheres that are due at the end of a step.
void Simulation::emit() {
    std::vector<scene::Sphere> births = flows_.emission.attempt(scene_, time() - scene_.step, time());
    for (scene::Sphere& birth : births) wrap(birth.position, scene_.bounds);
    if (births.empty()) return;
    std::vector<bool> free = freePlaces(births);
    const std::uint64_t pairsEach = std::max<std::uint64_t>(1, scene_.obstacles.size());
    const std::uint64_t most = std::min<std::uint64_t>(scene::maxSpheres, scene::maxObstaclePairs / pairsEach);
    std::vector<scene::Sphere> born;
    for (std::size_t k = 0; k < births.size(); ++k) {
        free[k] = free[k] && count() + born.size() < most;
        if (free[k]) born.push_back(births[k]);
    }
    if (!born.empty())
        if (const auto added = addBorn(born); !added) {
            free.assign(free.size(), false);
            if (!std::exchange(noticedNoRoom_, true))
                notices_.push_back(fmt::format("at step {}, emitters cannot make spheres, and try again: {}", steps_,
                                               added.error().text()));
        }
    flows_.emission.settle(scene_, free, time());
}

// Tells which births overlap neither walls nor obstacles, nor present spheres, nor births before them.
std::vector<bool> Simulation::freePlaces(std::span<const scene::Sphere> births) {
    scene_.time = time();  // of the obstacles
    std::vector<bool> taken(births.size());
    if (scene_.sphereContacts) {
        std::vector<glm::vec4> places;
        for (const scene::Sphere& birth : births)
            places.emplace_back(glm::vec3(birth.position - scene_.bounds.centre()), birth.radius);
        taken = pipeline_->takenPlaces(places);
    }
    scene::Occupancy occupancy(radii_.largest, scene_.bounds);
    std::vector<bool> free(births.size());
    for (std::size_t k = 0; k < births.size(); ++k) {
        const glm::dvec3& place = births[k].position;
        const auto radius = static_cast<double>(births[k].radius);
        free[k] = !taken[k] && !whyOutside(scene_.bounds, place, radius) && !obstacleAt(scene_, place, radius) &&
                  (!scene_.sphereContacts || occupancy.isFree(place, radius));
        if (free[k]) occupancy.add(place, radius);
    }
    return free;
}

// Adds new spheres. Refused, with the state unchanged, if there is no memory for them.
Result<void> Simulation::addBorn(std::span<const scene::Sphere> born) {
    const std::uint32_t before = count();
    if (fitsPlan(count() + born.size())) {
        if (auto room = makeRoomFor(static_cast<std::uint32_t>(born.size())); !room) return room;
        closeContactSums();
        keepLastFinite();
        append(born);
    } else {
        auto copies = memory::Claim::make("", "more spheres from emitters", copiesToSpawn(plan()));
        if (!copies) return tl::unexpected(copies.error());
        auto state = liveState();
        if (!state) return tl::unexpected(state.error());
        scene::Scene grown = scene_;
        grown.spheres.insert(grown.spheres.end(), born.begin(), born.end());
        state->append(stateOf(grown, born));
        Outcome outcome = prepare(ResetScope::Spheres, std::move(*copies), {std::move(grown), std::move(*state)});
        if (auto done = outcome.preparation->finish(); !done) return done;
        adopt(std::move(outcome.preparation));
    }
    for (std::uint32_t rank = before; rank < count(); ++rank) ++scene_.groups.at(scene_.spheres[rank].group).count;
    return {};
}

}  // namespace spherule::sim

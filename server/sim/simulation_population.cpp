// The part of Simulation that adds and removes spheres.
#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/log.h"
#include "scene/quality.h"
#include "sim/memory_needs.h"
#include "sim/parameters.h"
#include "sim/preparation.h"
#include "sim/simulation.h"

namespace spherule::sim {

// Keeps the spheres of the last good state. Call before spheres are added or removed.
void Simulation::keepLastFinite() {
    if (!lastFiniteSpheres_) lastFiniteSpheres_ = Spheres{population_, scene_.spheres, scene_.groups};
}

// True if the plan suits so many spheres.
bool Simulation::fitsPlan(std::uint64_t spheres) const {
    // With more spheres, the cells would be too few for them.
    constexpr std::uint32_t mostGrowth = 2;
    // Handles that rest, as many as spheres and more, would take room: others are given to all spheres then.
    constexpr std::uint64_t mostResting = 1024;
    const std::uint64_t handles = population_.handles() + spheres - count();
    if (handles > Pipeline::mostHandles) return false;
    if (handles > plan().room && handles > 2 * spheres + mostResting) return false;
    std::uint64_t planned = 0;
    for (const Level& level : plan().grid.levels) planned += level.spheres;
    return !plan().features.has(Feature::Contacts) || spheres <= mostGrowth * planned;
}

// True if the spheres that `grown` has in addition need no other arrays or kernels, and no cells of another size.
bool Simulation::canAppend(const scene::Scene& grown) const {
    // With empty groups gone, the present spheres have other groups.
    if (grown.groups.size() != scene_.groups.size() + 1) return false;
    if (!plan().features.hasAll(featuresOf(grown))) return false;
    if (!fitsPlan(grown.spheres.size())) return false;
    return std::ranges::all_of(grown.spheres.begin() + count(), grown.spheres.end(), [&](const scene::Sphere& sphere) {
        const auto radius = static_cast<double>(sphere.radius);
        return radius >= radii_.smallest && radius <= radii_.largest;
    });
}

// Makes room for more spheres in the arrays. Refused, with the state unchanged, if there is no memory for it.
Result<void> Simulation::makeRoomFor(std::uint32_t spheres) {
    const std::uint64_t handles = std::uint64_t{population_.handles()} + spheres;
    if (handles <= plan().room) return {};
    constexpr std::uint32_t leastGrowth = 1024;
    const std::uint64_t ahead = std::min<std::uint64_t>(
        std::uint64_t{plan().room} + std::max(plan().room / 2, leastGrowth), Pipeline::mostHandles);
    spdlog::info("making room for {} spheres", std::max(handles, ahead));
    auto grown = pipeline_->growSpheres(static_cast<std::uint32_t>(std::max(handles, ahead)), scene_);
    if (grown) settleClaim(claim_, device_, plan());
    return grown;
}

// Takes the spheres that a preparation has built, for which there is room. Cannot fail.
void Simulation::append(Preparation& preparation) {
    closeContactSums();
    keepLastFinite();
    scene::Scene& grown = preparation.built_.scene;
    scene_.groups = std::move(grown.groups);
    scene_.quality = grown.quality;
    append(std::span(grown.spheres).subspan(count()));
}

// Adds spheres for which there is room. Call closeContactSums() and keepLastFinite() before.
void Simulation::append(std::span<const scene::Sphere> added) {
    scene_.spheres.insert(scene_.spheres.end(), added.begin(), added.end());
    const State born = stateOf(scene_, added);
    std::vector<std::uint8_t> materials;
    for (const scene::Sphere& sphere : added) materials.push_back(sphere.material);
    pipeline_->append(born, materials, population_.add(born.count(), steps_));
    pairsExhausted_ = false;
    writeConstants(*pipeline_, scene_);
    maxSubsteps_ = scene::maxRaisedSubsteps(scene_);
    // Substeps that were raised for a fast sphere stay.
    useSubsteps(std::max(substeps_, scene_.quality.substeps));
    limitMotionOf(born);
    openContactSums();
    settleClaim(claim_, device_, plan());
}

// Removes the spheres with these ranks, in ascending order. Refused, with the state unchanged, if there is no memory.
Result<void> Simulation::remove(const std::vector<std::uint32_t>& ranks) {
    const auto room =
        memory::Claim::make("", "the numbers of the spheres", std::uint64_t{count()} * Population::bytesPerSphere);
    if (!room) return tl::unexpected(room.error());
    closeContactSums();
    keepLastFinite();
    std::vector<std::uint32_t> handles;
    for (const std::uint32_t rank : ranks) handles.push_back(population_.handleAt(rank));
    if (auto removed = pipeline_->remove(handles); !removed) {
        openContactSums();
        return removed;
    }
    pairsExhausted_ = false;
    population_.remove(ranks, steps_);
    scene::removeSpheres(scene_, ranks);
    uploadParameters();
    openContactSums();
    settleClaim(claim_, device_, plan());
    return {};
}

// Removes the spheres that are in sinks at the end of the step. Without memory for it they stay, until a later step.
void Simulation::emptySinks() {
    const std::vector<scene::Box> sinks = sinksOnDevice(scene_);
    const State state = snapshot();
    std::vector<std::uint32_t> ranks;
    std::vector<SinkFlow> flows = flows_.sinks;
    for (std::uint32_t rank = 0; rank < state.count(); ++rank) {
        const auto sink =
            std::ranges::find_if(sinks, [&](const scene::Box& box) { return box.contains(positionOf(state, rank)); });
        if (sink == sinks.end()) continue;
        ranks.push_back(rank);
        const scene::Sphere& sphere = scene_.spheres[rank];
        flows[static_cast<std::size_t>(sink - sinks.begin())].add(time(), sphere.material, massOf(scene_, sphere));
    }
    const std::uint32_t none = 0;
    pipeline_->write<std::uint32_t>(Array::Counters, std::span(&none, 1), COUNTER_SUNK);
    const auto removed = remove(ranks);
    if (removed) flows_.sinks = std::move(flows);
    if (!removed && !std::exchange(noticedFullSinks_, true))
        notices_.push_back(
            fmt::format("at step {}, sinks cannot take spheres, and try again: {}", steps_, removed.error().text()));
}

void Simulation::upload(const State& state) {
    std::vector<std::uint32_t> handles;
    if (!population_.plain())
        for (std::uint32_t rank = 0; rank < count(); ++rank) handles.push_back(population_.handleAt(rank));
    pipeline_->upload(state, materialsOf(scene_), handles);
    uploadParameters();
}

std::vector<std::uint32_t> Simulation::contactCounts() {
    const std::vector<std::uint32_t> byHandle = pipeline_->contactCounts();
    std::vector<std::uint32_t> counts(count());
    for (std::uint32_t rank = 0; rank < count(); ++rank) counts[rank] = byHandle[population_.handleAt(rank)];
    return counts;
}

}  // namespace spherule::sim

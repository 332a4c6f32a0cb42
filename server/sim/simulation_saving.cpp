// The part of Simulation that saves its state and restores it.
#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "core/archive.h"
#include "core/heartbeat.h"
#include "scene/archive.h"
#include "scene/load.h"
#include "sim/memory_needs.h"
#include "sim/simulation.h"

namespace spherule::sim {

namespace {

tl::unexpected<Error> notAState(const std::string& what) {
    return fail(ErrorKind::Input, "", "is no state that this version of the program can go on from: " + what);
}

bool sameSpheres(const std::vector<scene::Sphere>& one, const std::vector<scene::Sphere>& other) {
    // A sphere has no padding: its members fill it.
    static_assert(sizeof(scene::Sphere) == 56 && std::is_trivially_copyable_v<scene::Sphere>);
    return one.size() == other.size() &&
           (one.empty() || std::memcmp(one.data(), other.data(), one.size() * sizeof(scene::Sphere)) == 0);
}

// Returns true if each sphere of the population has one slot, and a material.
bool haveSlots(const std::vector<Pipeline::SavedArray>& arrays, const Population& population, std::size_t materials) {
    const auto saved = std::ranges::find(arrays, Array::IdAndMaterial, &Pipeline::SavedArray::array);
    std::vector<std::uint32_t> words(population.count());
    if (saved == arrays.end() || saved->bytes.size() < words.size() * sizeof(std::uint32_t)) return words.empty();
    if (!words.empty()) std::memcpy(words.data(), saved->bytes.data(), words.size() * sizeof(std::uint32_t));
    std::vector<bool> missing(population.handles());
    for (std::uint32_t rank = 0; rank < population.count(); ++rank) missing[population.handleAt(rank)] = true;
    return std::ranges::all_of(words, [&](std::uint32_t word) {
        const std::uint32_t handle = word & Pipeline::idMask;
        const bool fits = handle < missing.size() && missing[handle] && (word >> Pipeline::idBits) < materials;
        if (fits) missing[handle] = false;
        return fits;
    });
}

// Bytes for writing the meshes of a scene: a mesh is copied twice while its bytes grow.
std::uint64_t meshBytes(const scene::Scene& scene) {
    constexpr std::uint64_t perTriangle = 3 * 128;
    std::uint64_t bytes = 0;
    for (const scene::Obstacle& one : scene.obstacles)
        if (const auto mesh = one.shape->mesh()) bytes += mesh->corners.size() * perTriangle;
    return bytes;
}

}  // namespace

template <class Archive>
void archive(Archive& a, SizeClass& sizes) {
    auto& [smallest, largest, spheres] = sizes;
    a(smallest, largest, spheres);
}

template <class Archive>
void archive(Archive& a, RadiusStats& radii) {
    auto& [smallest, largest, mean, listing, classes] = radii;
    a(smallest, largest, mean, listing, classes);
}

template <class Archive>
void archive(Archive& a, Impacts& impacts) {
    auto& [count, approach, parting, asked] = impacts;
    a(count, approach, parting, asked);
}

template <class Archive>
void archive(Archive& a, SurfaceLoad& load) {
    auto& [impulse, moment] = load;
    a(impulse, moment);
}

template <class Archive>
void archive(Archive& a, ContactSums& sums) {
    auto& [seconds, collisions, dissipated, virial, loads] = sums;
    a(seconds, collisions, dissipated, virial, loads);
}

template <class Archive>
void archive(Archive& a, LoadUnits& units) {
    auto& [impulse, moment] = units;
    a(impulse, moment);
}

// All members but those that follow from these: the device, the pipeline, the rows made for it, the step under way, and
// notices. Drives follow the plan: see save().
template <class Archive>
void Simulation::archive(Archive& a) {
    bool asAtFirst = false;
    std::vector<scene::Sphere> spheres;
    if constexpr (!Archive::loads) {
        asAtFirst = sameSpheres(initial_.spheres, scene_.spheres);
        if (asAtFirst) spheres = std::exchange(initial_.spheres, {});
    }
    a(initial_, scene_, asAtFirst);
    if constexpr (Archive::loads)
        if (asAtFirst) initial_.spheres = scene_.spheres;
    if constexpr (!Archive::loads)
        if (asAtFirst) initial_.spheres = std::move(spheres);
    a(radii_, population_, flows_, counters_, observing_, impacts_, contactSums_, loadUnits_, lastFiniteSums_,
      sumsBegin_, elasticBefore_, noticedDropped_, pairsExhausted_, noticedSampled_, noticedCutShort_,
      noticedFullSinks_, noticedNoRoom_, substeps_, maxSubsteps_, quietSteps_, backoff_, lowered_, tooFast_, pulls_,
      lastFiniteStep_, lastFiniteDrives_, lastFiniteFlows_, lastFiniteSpheres_, steps_, generation_, partsVersion_,
      groupsVersion_);
}

Result<SavedState> Simulation::save() {
    if (device_.hostBytes(sizeof(float), "r") > sizeof(float))
        return fail(ErrorKind::Refused, "",
                    "the state of cpu-double cannot be saved: copies of it are rounded to float");
    if (midStep()) return fail(ErrorKind::Refused, "", "a step is under way; save the state when it has ended");
    SavedState saved;
    const std::uint64_t host = (3 * std::uint64_t{count()} + initial_.spheres.size()) * sizeof(scene::Sphere) +
                               meshBytes(scene_) + meshBytes(initial_);
    auto claim = memory::Claim::make("", "a copy of the state", plan().bytes() + host);
    if (!claim) return tl::unexpected(claim.error());
    saved.claim = std::move(*claim);
    Saver saver;
    archive(saver);
    saver(numbersOf(plan()), plan().maxWallHistory, pipeline_->launchState(), *drives_);
    saved.host = saver.take();
    saved.arrays = pipeline_->saveArrays();
    if (auto alive = device_.status(); !alive) return tl::unexpected(alive.error());
    return saved;
}

Result<std::unique_ptr<Simulation>> Simulation::restore(compute::Device& device, const SavedState& saved) {
    std::unique_ptr<Simulation> made(new Simulation(device));
    Loader loader(saved.host);
    PlanNumbers numbers;
    std::uint32_t maxWallHistory = 0;
    Pipeline::LaunchState launches;
    made->archive(loader);
    loader(numbers, maxWallHistory, launches);
    if (!loader.ok()) return notAState("data on the host is cut off or invalid");
    scene::Scene& scene = made->scene_;
    const Population& population = made->population_;
    const bool whole = scene::isWhole(scene) && scene::isWhole(made->initial_) && population.isWhole() &&
                       population.count() == scene.spheres.size() && numbers.spheres == population.count() &&
                       numbers.room >= population.handles() && numbers.room <= Pipeline::mostHandles &&
                       made->flows_.emission.emitters() == scene.emitters.size() &&
                       made->flows_.sinks.size() == scene.sinks.size() && made->substeps_ > 0 &&
                       made->substeps_ <= scene::maxSubsteps &&
                       (!made->lastFiniteSpheres_ ||
                        (made->lastFiniteSpheres_->population.isWhole() &&
                         made->lastFiniteSpheres_->population.count() == made->lastFiniteSpheres_->spheres.size())) &&
                       haveSlots(saved.arrays, population, scene.materials.size());
    if (!whole) return notAState("its parts do not fit each other");

    Plan plan = planOf(scene, made->radii_, numbers);
    if (plan.maxWallHistory != maxWallHistory) return notAState("contacts are remembered otherwise");
    auto claim = claimFor(device, plan);
    if (!claim) return tl::unexpected(claim.error());
    made->claim_ = std::move(*claim);
    made->pipeline_ = std::make_unique<Pipeline>(device, std::move(plan));
    Pipeline& pipeline = *made->pipeline_;
    for (bool more = true; more;) {
        heartbeat::beat("making arrays and kernels");
        const auto next = pipeline.makeNext();
        if (!next) return tl::unexpected(next.error());
        more = *next;
    }
    if (!scene.emitters.empty())
        if (auto births = pipeline.makeBirths(); !births) return tl::unexpected(births.error());
    if (auto filled = pipeline.restore(saved.arrays, scene); !filled)
        return filled.error().kind == ErrorKind::Input ? notAState(filled.error().message)
                                                       : tl::unexpected(filled.error());
    made->obstacleRows_.emplace(scene, made->plan().meshes.get());
    made->drives_.emplace(scene, made->plan());
    loader(*made->drives_);
    if (!loader.ok() || loader.left() > 0) return notAState("data on the host is cut off or invalid");
    settleClaim(made->claim_, device, made->plan());
    pipeline.restore(launches);  // before the parameters: the length of the substep has not changed
    made->uploadParameters();
    pipeline.restore(launches);
    if (auto alive = device.status(); !alive) return tl::unexpected(alive.error());
    return made;
}

}  // namespace spherule::sim

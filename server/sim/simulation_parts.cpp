// The part of Simulation that changes fields, emitters, materials and groups.
#include <algorithm>
#include <utility>
#include <vector>

#include "scene/load.h"
#include "scene/quality.h"
#include "sim/memory_needs.h"
#include "sim/parameters.h"
#include "sim/preparation.h"
#include "sim/simulation.h"

namespace spherule::sim {

namespace {

using Part = scene::PartChange::Part;
using Kind = scene::PartChange::Kind;

// True if a changed material has more than another name.
bool changesLaws(scene::Material before, const scene::Material& after) {
    before.name = after.name;
    return before != after;
}

// True if the laws of contacts between spheres, walls and obstacles may differ after the change, or masses.
bool changesContacts(const scene::PartChange& change, const scene::Scene& before, const scene::Scene& after) {
    switch (change.part) {
        case Part::Materials:
            return change.kind == Kind::Changed &&
                   changesLaws(before.materials[change.number], after.materials[change.number]);
        case Part::Pairs:
            return true;
        case Part::Groups:
            return before.groups[change.number].material != after.groups[change.number].material;
        case Part::Fields:
        case Part::Emitters:
            break;
    }
    return false;
}

// True if facts for viewers differ: names of materials, or groups beside their spheres.
bool changesFacts(const scene::Scene& before, const scene::Scene& after) {
    return !std::ranges::equal(before.materials, after.materials, {}, &scene::Material::name, &scene::Material::name) ||
           !std::ranges::equal(before.groups, after.groups, scene::sameGroup);
}

}  // namespace

// True if the cells of the plan suit the spheres of the scene, and those that its emitters make.
bool Simulation::keepsGrid(const scene::Scene& changed) const {
    constexpr double mostGrowth = 2;  // as for fitsPlan()
    double expected = 0;
    bool within = true;
    scene::forEachSphere(changed, [&](const scene::Sphere& sphere, double weight) {
        const auto radius = static_cast<double>(sphere.radius);
        within = within && radius >= radii_.smallest && radius <= radii_.largest;
        expected += weight;
    });
    if (!plan().features.has(Feature::Contacts) || changed.emitters.size() <= scene_.emitters.size()) return within;
    double planned = 0;
    for (const Level& level : plan().grid.levels) planned += level.spheres;
    return within && expected <= mostGrowth * planned;
}

// True if the arrays and kernels of the plan suit the scene, and no others would be made for it.
bool Simulation::keepsKernels(const scene::Scene& changed) const {
    if (!keepsGrid(changed) || featuresOf(changed) != featuresOf(scene_)) return false;
    if (scene_.emitters.empty() && !changed.emitters.empty()) return false;
    return changed.materials.size() == scene_.materials.size() || !plan().has(Array::ContactParams);
}

// Refuses a change while the state is not finite: it would be kept as the last good one.
Result<void> Simulation::checkFinite() {
    const auto counters = pipeline_->read<std::uint32_t>(Array::Counters);
    if (counters[COUNTER_NON_FINITE] == 0) return {};
    return fail(
        ErrorKind::Refused, "",
        "a sphere has no finite position any more; change the scene after it has gone back to its last good state");
}

Result<Simulation::Outcome> Simulation::changePart(const ChangePart& change) {
    if (auto finite = checkFinite(); !finite) return tl::unexpected(finite.error());
    auto copies = memory::Claim::make("", "a change of the scene", copiesToChange(plan()));
    if (!copies) return tl::unexpected(copies.error());
    scene::Scene changed = scene_;
    changed.time = time();
    auto made = change.make(changed);
    if (!made) {
        made.error().kind = ErrorKind::Refused;
        return tl::unexpected(made.error());
    }
    if (!keepsKernels(changed))
        return Outcome{.preparation =
                           std::make_unique<Preparation>(std::move(changed), std::move(*copies), *this, change)};
    takePart(std::move(changed), *made, nullptr);
    return Outcome{.applied = {.number = made->number}};
}

// Takes a changed scene. `preparation`: with the arrays and kernels for it; null: the present ones suit it. Cannot
// fail.
void Simulation::takePart(scene::Scene changed, const scene::PartChange& change, Preparation* preparation) {
    closeContactSums();
    const scene::Forces before = scene_.forces;
    const bool raised = substeps_ > scene_.quality.substeps;  // for a fast sphere
    const bool acts = changesContacts(change, scene_, changed);
    if (changesFacts(scene_, changed)) ++groupsVersion_;
    const bool newCells = preparation != nullptr && takePipeline(*preparation, changed);
    scene_ = std::move(changed);
    const bool renumbers = change.part == Part::Materials && change.kind == Kind::Removed;
    if (renumbers || (acts && change.part != Part::Pairs)) {
        std::vector<std::uint8_t> materials(population_.handles());
        std::vector<float> inverseMasses(population_.handles());
        for (std::uint32_t rank = 0; rank < count(); ++rank) {
            const scene::Sphere& sphere = scene_.spheres[rank];
            materials[population_.handleAt(rank)] = sphere.material;
            inverseMasses[population_.handleAt(rank)] = inverseMassOf(scene_, sphere);
        }
        pipeline_->setMaterials(materials, inverseMasses);
    }
    flows_.follow(change, scene_, time());
    writeConstants(*pipeline_, scene_);
    if (preparation != nullptr) {
        obstacleRows_.emplace(scene_, plan().meshes.get());
        drives_.emplace(scene_, plan());
    }
    maxSubsteps_ = scene::maxRaisedSubsteps(scene_);
    useSubsteps(raised ? std::max(substeps_, scene_.quality.substeps) : scene_.quality.substeps);
    openContactSums();
    if (change.part == Part::Fields) wakeWhere(before);
    if (acts) pipeline_->wakeAll();
    saveLastFinite();  // the kept spheres may name groups and materials by other numbers
    ++partsVersion_;
    if (newCells) ++generation_;
}

// Goes on with other arrays and kernels. Returns true if the cells, and so the handles of the spheres, are new.
bool Simulation::takePipeline(Preparation& preparation, const scene::Scene& changed) {
    addImpacts(impacts_, *pipeline_);
    if (preparation.basis_.keepsGrid) {
        preparation.pipeline_->takeFrom(*pipeline_);
    } else {
        State state = std::move(preparation.built_.state);
        for (glm::vec4& velocity : state.velocity) velocity.w = std::abs(velocity.w);
        preparation.pipeline_->upload(state, materialsOf(changed));
        population_.renumber();
        counters_ = {};
        pairsExhausted_ = false;
    }
    radii_ = preparation.basis_.radii;
    pipeline_ = std::move(preparation.pipeline_);
    claim_ = std::move(preparation.claim_);
    settleClaim(claim_, device_, plan());
    return !preparation.basis_.keepsGrid;
}

// Wakes the spheres that the forces accelerate otherwise than those `before` did.
void Simulation::wakeWhere(const scene::Forces& before) {
    if (!plan().features.has(Feature::Sleep)) return;
    const State state = snapshot();
    const glm::dvec3 centre = scene_.bounds.centre();
    const auto at = [](const scene::Forces& forces, const glm::dvec3& place, const scene::Body& body) {
        return forces.accelerationAt(place, body) + forces.dragAt(place, glm::dvec3(0), body);
    };
    std::vector<std::uint32_t> handles;
    for (std::uint32_t rank = 0; rank < state.count(); ++rank) {
        const glm::dvec3 place = positionOf(state, rank) + centre;
        const scene::Body body = scene::bodyOf(scene_, scene_.spheres[rank]);
        if (at(scene_.forces, place, body) != at(before, place, body)) handles.push_back(population_.handleAt(rank));
    }
    pipeline_->wake(handles);
}

Result<Simulation::Outcome> Simulation::removeGroup(const RemoveGroup& removed) {
    if (auto right = scene::checkNumber(removed.number, scene_.groups.size(), "groups"); !right)
        return tl::unexpected(right.error());
    if (auto finite = checkFinite(); !finite) return tl::unexpected(finite.error());
    const auto copies = memory::Claim::make("", "removing spheres", copiesToChange(plan()));
    if (!copies) return tl::unexpected(copies.error());
    std::vector<std::uint32_t> ranks;
    for (std::uint32_t rank = 0; rank < count(); ++rank)
        if (scene_.spheres[rank].group == removed.number) ranks.push_back(rank);
    if (!ranks.empty())
        if (auto done = remove(ranks); !done) return tl::unexpected(done.error());
    if (!scene::emitterOf(scene_, removed.number)) scene::removeGroup(scene_, removed.number);
    saveLastFinite();
    ++partsVersion_;
    ++groupsVersion_;
    return Outcome{.applied = {.removed = static_cast<std::uint32_t>(ranks.size()), .number = removed.number}};
}

}  // namespace spherule::sim

#include "kernels_bed.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include <glm/geometric.hpp>

namespace spherule::kernels {

namespace {

constexpr uint capacity = 512;  // pairs
constexpr uint cells = 8;       // per axis
constexpr uint idMask = 0xffffff;

}  // namespace

Bed::Bed(std::vector<vec4> places, std::uint64_t has)
    : count(static_cast<uint>(places.size())), features(has), position(std::move(places)) {
    parameters.spheres = count;
    parameters.cells = uvec4(cells, cells, cells, cells * cells * cells);
    parameters.groups = parameters.cells.w / 64;
    parameters.levelSize[0] = vec4(1 / 1.1F, 0.5F, 64, 0);
    parameters.inverseCell = 1 / 1.1F;
    parameters.margin = 0.1F;
    parameters.radius = 0.5F;
    parameters.substep = 1 / 480.0F;
    parameters.perSubstep = 480;
    parameters.pairCapacity = capacity;
    parameters.materials = 1;
    for (auto* column : {&positionLow, &angularVelocity, &velocityBefore, &deltaVelocity, &deltaOmega, &sortScratch_})
        column->assign(count, vec4(0));
    velocity.assign(count, vec4(0, 0, 0, 1));
    for (auto* column : {&idAndMaterial, &rankInCell_, &cellOrder_, &wakeFlags_, &sortScratchWords_})
        column->resize(count);
    std::iota(idAndMaterial.begin(), idAndMaterial.end(), 0U);
    cellStart.resize(parameters.cells.w + 1);
    pairs.resize(capacity);
    touching.resize(capacity);
    normalImpulses.resize(capacity);
    groupRange.resize(parameters.cells.w / 8);
    tangentialSlip.resize(capacity);
    carriedSlip_.resize(capacity);
    carriedOffsets_.resize(count + 1);
}

void Bed::run(std::string_view kernel, uint phase) {
    const Slot slots[] = {{"position", position},
                          {"positionLow", positionLow},
                          {"velocity", velocity},
                          {"angularVelocity", angularVelocity},
                          {"velocityBefore", velocityBefore},
                          {"deltaVelocity", deltaVelocity},
                          {"deltaOmega", deltaOmega},
                          {"idAndMaterial", idAndMaterial},
                          {"contactParams", contactParams},
                          {"cellStart", cellStart},
                          {"rankInCell", rankInCell_},
                          {"cellOrder", cellOrder_},
                          {"wakeFlags", wakeFlags_},
                          {"counters", counters},
                          {"pairs", pairs},
                          {"touching", touching},
                          {"normalImpulses", normalImpulses},
                          {"groupRange", groupRange},
                          {"tangentialSlip", tangentialSlip},
                          {"carriedOffsets", carriedOffsets_},
                          {"carriedSlip", carriedSlip_}};
    launch(kernel, slots, {.parameters = &parameters, .phase = phase, .features = features});
}

void Bed::rebuild() {
    run("slip_clear");
    run("slip_count");
    prefixSum(carriedOffsets_);
    run("slip_carry");
    run("cell_clear");
    run("cell_count");
    prefixSum(cellStart);
    run("cell_scatter");
    run("cell_order");
    sortColumns();
    counters[COUNTER_PAIRS] = 0;
    counters[COUNTER_UNLISTED] = 0;
    run("list_build");
    run("list_fit");
    run("slip_restore");
}

void Bed::sortColumns() {
    const Launch how{.parameters = &parameters, .phase = 0, .features = features};
    for (auto* column : {&position, &positionLow, &velocity, &angularVelocity, &velocityBefore}) {
        const Slot slots[] = {{"column", *column}, {"cellOrder", cellOrder_}, {"sortScratch", sortScratch_}};
        launch("sort_vectors", slots, how);
        launch("copy_vectors", slots, how);
    }
    const Slot slots[] = {
        {"column", idAndMaterial}, {"cellOrder", cellOrder_}, {"sortScratchWords", sortScratchWords_}};
    launch("sort_words", slots, how);
    launch("copy_words", slots, how);
}

void Bed::sweep(std::string_view kernel) {
    for (uint colour = 0; colour < 8; ++colour) run(kernel, colour);
}

uint Bed::slotOf(uint id) const {
    for (uint slot = 0; slot < count; ++slot)
        if ((idAndMaterial[slot] & idMask) == id) return slot;
    throw std::out_of_range("id");
}

float Bed::radiusOf(uint id) const {
    return (features & Feature::RADII) != 0 ? position[slotOf(id)].w : parameters.radius;
}

vec3 Bed::normal(uint a, uint b) const {
    return glm::normalize(at(a) - at(b));
}

vec3 Bed::slip(uint a, uint b) const {
    const vec3 n = normal(a, b);
    const vec3 speed = velocityOf(a) - velocityOf(b);
    return speed - n * glm::dot(speed, n) - glm::cross(spinOf(a) * radiusOf(a) + spinOf(b) * radiusOf(b), n);
}

vec3 Bed::momentum() const {
    vec3 sum(0);
    for (uint id = 0; id < count; ++id) sum += massOf(id) * velocityOf(id);
    return sum;
}

vec3 Bed::angularMomentum() const {
    vec3 sum(0);
    for (uint id = 0; id < count; ++id) {
        const float inertia = 0.4F * massOf(id) * radiusOf(id) * radiusOf(id);
        sum += massOf(id) * glm::cross(at(id), velocityOf(id)) + inertia * spinOf(id);
    }
    return sum;
}

float Bed::energy() const {
    float sum = 0;
    for (uint id = 0; id < count; ++id) {
        const float inertia = 0.4F * massOf(id) * radiusOf(id) * radiusOf(id);
        sum += 0.5F * massOf(id) * glm::dot(velocityOf(id), velocityOf(id));
        sum += 0.5F * inertia * glm::dot(spinOf(id), spinOf(id));
    }
    return sum;
}

std::vector<uint> Bed::listed() const {
    std::vector<uint> found;
    for (const uvec4& group : groupRange)
        for (uint k = group.x; group.y != UNLISTED && k < group.x + group.y; ++k) found.push_back(k);
    return found;
}

uvec2 Bed::idsOf(uint pair) const {
    return {idAndMaterial[pairs[pair].x] & idMask, idAndMaterial[pairs[pair].y] & idMask};
}

std::vector<uint> Bed::inTouch() const {
    std::vector<uint> found;
    for (const uvec4& group : groupRange)
        for (uint k = 0; k < group.z; ++k) found.push_back(group.x + k);
    return found;
}

uvec2 Bed::idsInTouch(uint pair) const {
    return {idAndMaterial[touching[pair].x] & idMask, idAndMaterial[touching[pair].y] & idMask};
}

void Bed::pressAll(float impulse) {
    for (uvec4& group : groupRange) group.z = group.y;
    for (const uint k : listed()) {
        touching[k] = pairs[k];
        normalImpulses[k] = impulse;
    }
}

}  // namespace spherule::kernels

#include "kernels_bed.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <stdexcept>

#include <glm/geometric.hpp>

namespace spherule::kernels {

namespace {

constexpr uint capacity = 512;  // pairs
constexpr uint cells = 8;       // per axis
constexpr uint idMask = 0xffffff;

}  // namespace

Bed::Bed(std::vector<vec4> places, uint has)
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
    position.resize(std::size_t{2} * count);
    velocity.assign(std::size_t{4} * count, vec4(0));
    std::fill_n(velocity.begin(), count, vec4(0, 0, 0, 1));
    before.assign(count, vec4(0));
    label.resize(count);
    std::iota(label.begin(), label.end(), 0U);
    cellStart.resize(parameters.cells.w + 1);
    pairs.resize(std::size_t{3} * capacity);
    span.resize(parameters.cells.w / 8);
    history.resize(capacity);
    kept_.resize(capacity);
    keptStart_.resize(count + 1);
}

Launch Bed::launchOf(uint phase) const {
    return {.parameters = &parameters, .phase = phase, .features = features};
}

void Bed::rebuild() {
    keepHistory();
    sortState();
    counters[COUNTER_PAIRS] = 0;
    counters[COUNTER_UNLISTED] = 0;
    launch("list_build", {position, cellStart, counters, pairs, span}, launchOf());
    launch("list_fit", {counters, span}, launchOf());
    launch("history_fetch", {position, label, span, pairs, history, keptStart_, kept_}, launchOf());
}

void Bed::keepHistory() {
    launch("history_clear", {keptStart_}, launchOf());
    launch("history_count", {position, label, span, pairs, history, keptStart_}, launchOf());
    prefixSum(keptStart_);
    launch("history_keep", {position, label, span, pairs, history, keptStart_, kept_}, launchOf());
}

void Bed::sortState() {
    std::vector<uint> place(count);
    std::vector<uint> order(count);
    std::vector<uint> savedLabel(count);
    std::vector<uint> woken(count);
    std::vector<vec4> saved(std::size_t{5} * count);
    launch("state_save", {position, velocity, before, label, saved, savedLabel, woken}, launchOf());
    launch("cell_clear", {cellStart}, launchOf());
    launch("cell_count", {position, cellStart, place}, launchOf());
    prefixSum(cellStart);
    launch("cell_scatter", {position, cellStart, place, order}, launchOf());
    launch("cell_order", {cellStart, order, label}, launchOf());
    launch("state_gather", {position, velocity, before, label, saved, savedLabel, order}, launchOf());
}

void Bed::sweep(std::string_view kernel, std::initializer_list<Slot> slots) {
    for (uint colour = 0; colour < 8; ++colour) launch(kernel, slots, launchOf(colour));
}

uint Bed::slotOf(uint id) const {
    for (uint slot = 0; slot < count; ++slot)
        if ((label[slot] & idMask) == id) return slot;
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
    for (const uvec4& group : span)
        for (uint k = group.x; group.y != UNLISTED && k < group.x + group.y; ++k) found.push_back(k);
    return found;
}

std::vector<uint> Bed::touching() const {
    std::vector<uint> found;
    for (const uvec4& group : span)
        for (uint k = 0; k < group.z; ++k) found.push_back(capacity + group.x + k);
    return found;
}

uvec2 Bed::idsOf(uint pair) const {
    return {label[pairs[pair].x] & idMask, label[pairs[pair].y] & idMask};
}

float Bed::pressing(uint pair) const {
    return std::bit_cast<float>(pairs[capacity + pair].x);
}

void Bed::pressAll(float impulse) {
    for (uvec4& group : span) group.z = group.y;
    for (const uint k : listed()) {
        pairs[capacity + k] = pairs[k];
        pairs[2 * capacity + k] = uvec2(std::bit_cast<uint>(impulse), 0);
    }
}

}  // namespace spherule::kernels

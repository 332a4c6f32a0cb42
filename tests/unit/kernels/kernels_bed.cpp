#include "kernels_bed.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <glm/geometric.hpp>

namespace spherule::kernels {

namespace {

constexpr uint capacity = 8192;  // pairs
constexpr uint cells = 8;        // per axis
constexpr uint idMask = 0xffffff;
constexpr uint wallRows = 4;  // one for each axis of the bounds, one for an obstacle

// As the simulation's plan: see server/sim/modules/contact_memory.cpp.
std::uint64_t withContactMemory(std::uint64_t has) {
    const bool remembers = (has & Feature::BALANCED) != 0 || (has & Feature::FRICTION) != 0;
    return (has & Feature::CONTACTS) != 0 && remembers ? has | Feature::CONTACT_MEMORY : has;
}

}  // namespace

Bed::Bed(std::vector<vec4> places, std::uint64_t has)
    : count(static_cast<uint>(places.size())), features(withContactMemory(has)), position(std::move(places)) {
    parameters.spheres = count;
    parameters.cells = uvec4(cells, cells, cells, cells * cells * cells);
    parameters.levels = 1;
    parameters.levelCells[0] = uvec4(cells, cells, cells, 0);
    parameters.levelSize[0] = vec4(1 / 1.1F, 0.5F, 64, 0);
    parameters.levelBundles[0] = uvec4(0, 1, 0, 0);
    parameters.bundles = 8;
    parameters.inverseCell = 1 / 1.1F;
    parameters.margin = 0.1F;
    parameters.rebuildMove = 0.045F;
    parameters.radius = 0.5F;
    parameters.substep = 1 / 480.0F;
    parameters.perSubstep = 480;
    parameters.pairCapacity = capacity;
    parameters.materials = 1;
    parameters.maxWallHistory = wallRows;
    parameters.wallMin = vec4(-100, -100, -100, 0);
    parameters.wallMax = vec4(100, 100, 100, 0);
    parameters.substepRatio = 1;
    for (auto* column : {&positionLow, &angularVelocity, &velocityBefore, &deltaVelocity, &deltaOmega, &unheldVelocity,
                         &unheldSpin, &listReference, &sortScratch_})
        column->assign(count, vec4(0));
    velocity.assign(count, vec4(0, 0, 0, 1));
    for (auto* column :
         {&idAndMaterial, &accelerationXz, &accelerationYz, &rankInCell_, &slots_, &carriedCount_, &sortScratchWords_})
        column->resize(count);
    busyBatches_.resize(std::size_t{8} * count);
    cellOrder_.resize(std::max(count, MOST_OUTSIDE));
    std::iota(idAndMaterial.begin(), idAndMaterial.end(), 0U);
    nearObstacles.resize(count);  // without room: each sphere visits all obstacles
    wallImpulse.assign(std::size_t{count} * wallRows, vec4(0));
    wallTorque.assign(std::size_t{count} * wallRows, vec4(0));
    cellStart.resize(parameters.cells.w + 1);
    for (auto* list : {&pairs, &candidates}) list->resize(capacity);
    constexpr float anything = std::numeric_limits<float>::quiet_NaN();  // see contact_memory.h
    const bool torques = (features & Feature::BALANCED) != 0 && (features & Feature::FRICTION) != 0;
    for (auto* half : {&contactX, &contactY, &contactZ}) half->assign(std::size_t{2} * capacity, anything);
    for (auto* half : {&torqueX, &torqueY, &torqueZ}) half->assign(std::size_t{2} * capacity, torques ? anything : 0);
    for (auto* column : {&sortedX_, &sortedY_, &sortedZ_, &sortedRadius_}) column->resize(count + PAIR_PADDING);
    carried_.resize(std::size_t{count} * CARRIED_MOST);
    groupRange.resize(parameters.cells.w / 8);
    bundles.resize(std::size_t{parameters.bundles + 1} * BUNDLE_WORDS);
    dispatchSizes.assign(std::size_t{2} * LAUNCH_ROWS, uvec4(1, 1, 1, 1));
    dispatchArgs.resize(LAUNCH_ROWS);
}

void Bed::run(std::string_view kernel, uint phase) {
    const Slot slots[] = {{"position", position},
                          {"positionLow", positionLow},
                          {"velocity", velocity},
                          {"angularVelocity", angularVelocity},
                          {"velocityBefore", velocityBefore},
                          {"deltaVelocity", deltaVelocity},
                          {"deltaOmega", deltaOmega},
                          {"unheldVelocity", unheldVelocity},
                          {"unheldSpin", unheldSpin},
                          {"accelerationXz", accelerationXz},
                          {"accelerationYz", accelerationYz},
                          {"listReference", listReference},
                          {"wallImpulse", wallImpulse},
                          {"wallTorque", wallTorque},
                          {"idAndMaterial", idAndMaterial},
                          {"contactParams", contactParams},
                          {"obstacles", obstacles},
                          {"obstacleLists", obstacleLists},
                          {"nearObstacles", nearObstacles},
                          {"cellStart", cellStart},
                          {"rankInCell", rankInCell_},
                          {"otherOrder", rankInCell_},
                          {"cellOfSphere", sortScratchWords_},
                          {"cellOrder", cellOrder_},
                          {"moverSlots", noMovers_},
                          {"isMover", noMovers_},
                          {"leftBlock", noMovers_},
                          {"slotOf", slots_},
                          {"busyBatches", busyBatches_},
                          {"sortedX", sortedX_},
                          {"sortedY", sortedY_},
                          {"sortedZ", sortedZ_},
                          {"sortedRadius", sortedRadius_},
                          {"counters", counters},
                          {"surfaceSums", surfaceSums},
                          {"pairs", pairs},
                          {"candidates", candidates},
                          {"groupRange", groupRange},
                          {"bundles", bundles},
                          {"contactX", contactX},
                          {"contactY", contactY},
                          {"contactZ", contactZ},
                          {"torqueX", torqueX},
                          {"torqueY", torqueY},
                          {"torqueZ", torqueZ},
                          {"carriedCount", carriedCount_},
                          {"carried", carried_},
                          {"dispatchSizes", dispatchSizes},
                          {"dispatchArgs", dispatchArgs}};
    launch(kernel, slots, {.parameters = &parameters, .phase = phase, .features = features, .lanes = lanes});
}

void Bed::setObstacles(uint number, uint shape) {
    parameters.obstacles = number;
    obstacleLists.assign(1, END_OF_LIST);
    for (uint k = 0; k < number; ++k) {
        obstacles[k].shape = shape;
        obstacles[k].parts = 1;
        obstacles[k].surface = 6 + k;
        obstacleLists.push_back(k);
    }
    obstacleLists.push_back(END_OF_LIST);
}

void Bed::rebuild() {
    counters[COUNTER_REBUILD] = REBUILD_DUE;
    run("rebuild_decide", 1);
    run("contacts_carry", 1);
    run("cell_clear");
    run("cell_count");
    prefixSum(cellStart);
    run("cell_scatter");
    run("cell_order");
    sortColumns();
    run("list_reference");
    run("list_drift");
    run("list_build");
    run("list_order");
    run("list_fit");
    run("contacts_restore");
    run("contacts_lost");
    if (dispatchArgs[LAUNCH_LOST_SPHERES].x != 0) run("held_by_walls");
    if (dispatchArgs[LAUNCH_LOST_COLOUR].x != 0) sweep("held_by_pairs");
}

void Bed::sortColumns() {
    const Launch how{.parameters = &parameters, .phase = 0, .features = features};
    for (auto* column :
         {&position, &positionLow, &velocity, &angularVelocity, &velocityBefore, &unheldVelocity, &unheldSpin}) {
        const Slot slots[] = {{"column", *column}, {"cellOrder", cellOrder_}, {"sortScratch", sortScratch_}};
        launch("sort_vectors", slots, how);
        launch("copy_vectors", slots, how);
    }
    for (auto* column : {&idAndMaterial, &accelerationXz, &accelerationYz}) {
        const Slot slots[] = {{"column", *column}, {"cellOrder", cellOrder_}, {"sortScratchWords", sortScratchWords_}};
        launch("sort_words", slots, how);
        launch("copy_words", slots, how);
    }
}

void Bed::sweep(std::string_view kernel) {
    for (uint colour = 0; colour < 8; ++colour) run(kernel, colour);
}

void Bed::begin() {
    bundles[parameters.bundles * BUNDLE_WORDS + WORD_FASTEST] = 0;
    run("begin_substep");
}

void Bed::solve() {
    sweep("solve_contacts");
    if (counters[COUNTER_UNLISTED] != 0) sweep("solve_unlisted");
}

void Bed::finish() {
    run("finish_substep");
}

void Bed::substep() {
    if ((counters[COUNTER_REBUILD] & REBUILD_DUE) != 0)
        rebuild();
    else
        run("rebuild_decide");
    begin();
    solve();
    finish();
}

uint Bed::slotOf(uint id) const {
    for (uint slot = 0; slot < count; ++slot)
        if ((idAndMaterial[slot] & idMask) == id) return slot;
    throw std::out_of_range("id");
}

vec3 Bed::heldVelocity(uint slot) const {
    return unheldVelocity[slot].w != 0 ? vec3(velocity[slot] - unheldVelocity[slot]) : vec3(0);
}

vec3 Bed::heldSpin(uint slot) const {
    return unheldVelocity[slot].w != 0 ? vec3(angularVelocity[slot] - unheldSpin[slot]) : vec3(0);
}

void Bed::setVelocity(uint id, vec3 to) {
    const vec4 change(to - velocityOf(id), 0);
    velocity[slotOf(id)] += change;
    unheldVelocity[slotOf(id)] += change;
}

void Bed::setSpin(uint id, vec3 to) {
    const vec4 change(to - spinOf(id), 0);
    angularVelocity[slotOf(id)] += change;
    unheldSpin[slotOf(id)] += change;
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

float Bed::partingSpeed(uint a, uint b) const {
    return glm::dot(velocityOf(a) - velocityOf(b), normal(a, b));
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

std::vector<Bed::Listed> Bed::order() const {
    std::vector<Listed> found;
    for (uint bundle = 0; bundle < parameters.bundles; ++bundle) {
        const uint* const words = &bundles[std::size_t{bundle} * BUNDLE_WORDS];
        if (words[1] == UNLISTED || words[1] == 0) continue;
        uint place = words[0];
        for (uint batch = 0; batch <= BATCHES; ++batch)
            for (; place < words[4 + batch]; ++place) found.push_back({place, bundle, batch});
    }
    return found;
}

std::vector<uint> Bed::listed() const {
    std::vector<uint> found;
    for (const Listed& one : order()) found.push_back(one.place);
    return found;
}

uvec2 Bed::idsOf(uint pair) const {
    return {idAndMaterial[pairs[pair].x] & idMask, idAndMaterial[SECOND_OF(pairs[pair])] & idMask};
}

std::optional<uint> Bed::placeOf(uint a, uint b) const {
    for (const uint place : listed())
        if (idsOf(place) == uvec2(a, b) || idsOf(place) == uvec2(b, a)) return place;
    return std::nullopt;
}

uint Bed::present() const {
    return (counters[COUNTER_LISTS] & 1U) * parameters.pairCapacity;
}

vec3 Bed::remembered(uint pair) const {
    const uint at = present() + pair;
    if ((pairs[pair].y & PAIR_REMEMBERS) == 0) return vec3(0);
    const vec3 value = {contactX[at], contactY[at], contactZ[at]};
    EXPECT_NE(value, vec3(0)) << "pair " << pair;
    return value;
}

vec3 Bed::ownAcceleration(uint slot) const {
    const uint xz = accelerationXz[slot];
    const uint yz = accelerationYz[slot];
    return {std::bit_cast<float>(ACCELERATION_X_BITS(xz, yz)), std::bit_cast<float>(ACCELERATION_Y_BITS(xz, yz)),
            std::bit_cast<float>(ACCELERATION_Z_BITS(xz, yz))};
}

vec3 Bed::rememberedTorque(uint pair) const {
    const uint at = present() + pair;
    if ((pairs[pair].y & PAIR_REMEMBERS) == 0) return vec3(0);
    return {torqueX[at], torqueY[at], torqueZ[at]};
}

void Bed::remember(uint pair, vec3 value, vec3 torque) {
    const uint at = present() + pair;
    pairs[pair].y = SECOND_OF(pairs[pair]) | (value != vec3(0) ? PAIR_REMEMBERS : 0);
    contactX[at] = value.x;
    contactY[at] = value.y;
    contactZ[at] = value.z;
    torqueX[at] = torque.x;
    torqueY[at] = torque.y;
    torqueZ[at] = torque.z;
}

void Bed::pressAll(float impulse) {
    for (const uint k : listed()) remember(k, impulse * normal(idsOf(k).x, idsOf(k).y));
}

void Bed::holdAll(float impulse) {
    pressAll(impulse);
    addUpHeld();
}

void Bed::addUpHeld() {
    run("held_by_walls");
    sweep("held_by_pairs");
}

}  // namespace spherule::kernels

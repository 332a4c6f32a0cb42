#pragma once

#include <vector>

#include "compute/cpu/features.h"
#include "kernels_support.h"

namespace spherule::kernels {

using Feature = compute::cpu::Features;

// Spheres of up to 0.5 m in cells of 1.1 m, with the lists and arrays that the pair kernels use. Each has 1 kg and the
// first material. Tests use ids, because slots change with every rebuild.
struct Bed {
    explicit Bed(std::vector<vec4> places, std::uint64_t has = 0);

    // Rebuilds the lists in the order of the simulation's plan, and carries over the history of contacts.
    void rebuild();

    // Runs a kernel over all groups, one colour after another.
    void sweep(std::string_view kernel);

    uint slotOf(uint id) const;
    float radiusOf(uint id) const;
    float massOf(uint id) const { return 1 / velocity[slotOf(id)].w; }
    vec3 at(uint id) const { return vec3(position[slotOf(id)]); }
    vec3 velocityOf(uint id) const { return vec3(velocity[slotOf(id)]); }
    vec3 spinOf(uint id) const { return vec3(angularVelocity[slotOf(id)]); }
    void setMass(uint id, float mass) { velocity[slotOf(id)].w = 1 / mass; }
    void setPlace(uint id, vec3 to) { position[slotOf(id)] = vec4(to, position[slotOf(id)].w); }
    void setVelocity(uint id, vec3 to) { velocity[slotOf(id)] = vec4(to, velocity[slotOf(id)].w); }
    void setSpin(uint id, vec3 to) { angularVelocity[slotOf(id)] = vec4(to, 0); }

    vec3 normal(uint a, uint b) const;  // from b to a
    vec3 slip(uint a, uint b) const;    // tangential velocity of the surface of `a` relative to the surface of `b`

    vec3 momentum() const;
    vec3 angularMomentum() const;
    float energy() const;

    // Indices into `pairs`, and the ids of one pair.
    std::vector<uint> listed() const;
    uvec2 idsOf(uint pair) const;
    // Indices into `touching` and `normalImpulses`, and the ids of one pair.
    std::vector<uint> inTouch() const;
    uvec2 idsInTouch(uint pair) const;

    // Makes all listed pairs touch, with this normal impulse (N s).
    void pressAll(float impulse);

    uint count;
    std::uint64_t features;
    layout::Parameters parameters{};
    std::vector<vec4> position, positionLow, velocity, angularVelocity, velocityBefore, deltaVelocity, deltaOmega;
    std::vector<uint> idAndMaterial;
    std::vector<layout::ContactParams> contactParams = std::vector<layout::ContactParams>(1);
    std::vector<uint> cellStart;
    std::vector<uint> counters = std::vector<uint>(COUNTER_WORDS);
    std::vector<uvec2> pairs, touching;
    std::vector<float> normalImpulses;  // N s
    std::vector<uvec4> groupRange;
    std::vector<vec4> tangentialSlip;

  private:
    void run(std::string_view kernel, uint phase = 0);
    void sortColumns();

    std::vector<uint> carriedOffsets_, rankInCell_, cellOrder_, wakeFlags_, sortScratchWords_;
    std::vector<vec4> carriedSlip_, sortScratch_;
};

}  // namespace spherule::kernels

#pragma once

#include <optional>
#include <vector>

#include "compute/cpu/features.h"
#include "kernels_support.h"

namespace spherule::kernels {

using Feature = compute::cpu::Features;

// Spheres of up to 0.5 m in cells of 1.1 m, with the lists and arrays that the contact kernels use. Each has 1 kg and
// the first material. Tests use ids, because slots change with every rebuild.
struct Bed {
    explicit Bed(std::vector<vec4> places, std::uint64_t has = 0);

    // Rebuilds the lists in the order of the simulation's plan, and carries over the memory of contacts.
    void rebuild();

    // Runs a kernel once, or over all bundles, one colour after another.
    void run(std::string_view kernel, uint phase = 0);
    void sweep(std::string_view kernel);

    // The passes of a substep of the model `balanced`. substep() runs all three, after a rebuild if one is due.
    void begin();
    void solve();
    void finish();
    void substep();

    uint slotOf(uint id) const;
    float radiusOf(uint id) const;
    float massOf(uint id) const { return 1 / velocity[slotOf(id)].w; }
    vec3 at(uint id) const { return vec3(position[slotOf(id)]); }
    vec3 velocityOf(uint id) const { return vec3(velocity[slotOf(id)]); }
    vec3 spinOf(uint id) const { return vec3(angularVelocity[slotOf(id)]); }
    void setMass(uint id, float mass) { velocity[slotOf(id)].w = 1 / mass; }
    void setPlace(uint id, vec3 to) { position[slotOf(id)] = vec4(to, position[slotOf(id)].w); }
    // The changes of a sphere's velocity and spin by the impulses that its contacts hold.
    vec3 heldVelocity(uint slot) const;
    vec3 heldSpin(uint slot) const;
    // A sphere keeps what its contacts hold.
    void setVelocity(uint id, vec3 to);
    void setSpin(uint id, vec3 to);

    vec3 normal(uint a, uint b) const;  // from b to a
    vec3 slip(uint a, uint b) const;    // tangential velocity of the surface of `a` relative to the surface of `b`
    float partingSpeed(uint a, uint b) const;

    vec3 momentum() const;
    vec3 angularMomentum() const;
    float energy() const;

    // A listed pair: its place in `pairs`, its bundle and its batch. Pairs without a batch have the batch BATCHES.
    struct Listed {
        uint place, bundle, batch;
    };
    std::vector<Listed> order() const;
    std::vector<uint> listed() const;  // the places alone
    uvec2 idsOf(uint pair) const;
    std::optional<uint> placeOf(uint a, uint b) const;  // of the pair of these ids, in any order

    // The memory of a listed contact, as the first sphere of the pair sees it.
    vec3 remembered(uint pair) const;
    vec3 rememberedTorque(uint pair) const;
    vec3 ownAcceleration(uint slot) const;  // m/s: change of the velocity in a substep, running mean
    void remember(uint pair, vec3 value, vec3 torque = vec3(0));

    // Makes all listed contacts hold this normal impulse (N s), as in the middle of a substep.
    void pressAll(float impulse);
    // The same between two substeps: the spheres have the changes of velocity that the contacts hold.
    void holdAll(float impulse);
    void addUpHeld();

    // Gives the bed the first `number` rows of `obstacles`, all of one shape: its number in shapes.def.
    void setObstacles(uint number, uint shape = 0);

    uint count;
    std::uint64_t features;
    unsigned lanes = 1;
    layout::Parameters parameters{};
    std::vector<vec4> position, positionLow, velocity, angularVelocity, velocityBefore, deltaVelocity, deltaOmega;
    std::vector<vec4> unheldVelocity, unheldSpin, listReference, wallImpulse, wallTorque;
    std::vector<uint> idAndMaterial, accelerationXz, accelerationYz;
    std::vector<layout::ContactParams> contactParams = std::vector<layout::ContactParams>(1);
    std::vector<layout::Obstacle> obstacles = std::vector<layout::Obstacle>(2);
    std::vector<uint> obstacleLists{END_OF_LIST, END_OF_LIST};
    std::vector<uvec2> nearObstacles;
    std::vector<uint> cellStart;
    std::vector<uint> counters = std::vector<uint>(COUNTER_WORDS);
    std::vector<uint> surfaceSums = std::vector<uint>(8 * SURFACE_SUM_COPIES * SURFACE_SUM_WORDS);
    std::vector<uvec2> pairs, candidates, groupRange;
    std::vector<uint> bundles;
    std::vector<float> contactX, contactY, contactZ, torqueX, torqueY, torqueZ;
    std::vector<uvec4> dispatchSizes, dispatchArgs;

  private:
    void sortColumns();
    uint present() const;  // first element of the memory of the present lists

    std::vector<uint> rankInCell_, cellOrder_, slots_, busyBatches_, carriedCount_, sortScratchWords_;
    std::vector<uint> noMovers_ = std::vector<uint>(1);
    std::vector<float> sortedX_, sortedY_, sortedZ_, sortedRadius_;
    std::vector<uvec2> carried_;
    std::vector<vec4> sortScratch_;
};

}  // namespace spherule::kernels

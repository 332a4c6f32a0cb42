#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "compute/device.h"
#include "measure/scenes.h"
#include "reference.h"
#include "scene/load.h"
#include "scene/scene.h"
#include "sim/simulation.h"

namespace spherule::physics {

// The device of these tests: Mesa's software renderer, which every machine has, or what SPHERULE_TEST_DEVICE names.
std::unique_ptr<compute::Device> openTestDevice();
compute::Device& device();  // one for all tests

// A scene that comes with the program.
scene::Scene named(const std::string& name, const scene::Overrides& overrides = {});

// A cube of `side` m around the origin: all faces open, no gravity, no sleep, every step one substep of 1/480 s.
scene::Scene openSpace(double side);

// The same with closed faces and, downwards, the earth's gravity.
scene::Scene closedBox(double side);

// The same in steps of 1/60 s, eight substeps each, with sleep; everything has a restitution of 0.3.
scene::Scene sleepyBox(double side);

using measure::addMaterial;
using measure::earth;
using measure::setRestitution;

// Ends the test with the reason when the scene cannot be simulated.
std::unique_ptr<sim::Simulation> simulate(scene::Scene scene, compute::Device& on = device());

void run(sim::Simulation& simulation, double seconds);

// The reference in the state of a simulation: closed faces and planes are its walls, lengths are relative to the
// bounds' centre.
reference::World referenceOf(const scene::Scene& scene, const sim::State& state);

// Pairs that overlapped in the last substep and were pushed apart.
std::uint64_t touchingPairs(sim::Simulation& simulation);

// The slots of the pairs that are listed, the lower one first; sorted.
using SlotPair = std::pair<std::uint32_t, std::uint32_t>;
std::vector<SlotPair> listedPairs(sim::Simulation& simulation);

bool asleep(const sim::State& state, std::uint32_t id);
std::uint32_t sleepers(const sim::State& state);
bool allFinite(const sim::State& state);

}  // namespace spherule::physics

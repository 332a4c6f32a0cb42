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
#include "test_device.h"

namespace spherule::physics {

using support::openTestDevice;
compute::Device& device();  // one for all tests

// Loads a shipped scene.
scene::Scene named(const std::string& name, const scene::Overrides& overrides = {});

// Reads an obstacle in the form in which scenes give it. Throws std::invalid_argument if it is refused.
scene::Obstacle obstacleFrom(const std::string& json);

// A cube of `side` m around the origin with open faces, no gravity and no sleep. A step is one substep of 1/480 s.
scene::Scene fineStepSpace(double side);

// Same as fineStepSpace(), with closed faces and the earth's gravity downwards.
scene::Scene fineStepBox(double side);

// Same as fineStepBox(), with steps of 1/60 s, eight substeps per step, sleep, and a restitution of 0.3.
scene::Scene sleepyBox(double side);

// Chooses a model with its own number of substeps, and asks for contact sums. Throws std::runtime_error if it is
// refused.
void measureContacts(scene::Scene& scene, scene::Model model);

using measure::addMaterial;
using measure::earth;
using measure::setRestitution;

// Ends the test with an error message when the scene cannot be simulated.
std::unique_ptr<sim::Simulation> simulate(scene::Scene scene, compute::Device& on = device());

void run(sim::Simulation& simulation, double seconds);

// Returns the reference in the state of a simulation. Its walls are the closed faces and planes. Positions are relative
// to the centre of the bounds.
reference::World referenceOf(const scene::Scene& scene, const sim::State& state);

// Returns the reference in the state of a simulation of the model `balanced`, with all that its contacts hold.
reference::World referenceOf(sim::Simulation& simulation);

// Returns the number of listed pairs that touch or overlap.
std::uint64_t touchingPairs(sim::Simulation& simulation);

// The slots of the listed pairs, sorted; the lower slot of a pair comes first.
using SlotPair = std::pair<std::uint32_t, std::uint32_t>;
std::vector<SlotPair> pairsInOrder(sim::Simulation& simulation);  // as the solvers visit them, one level
std::vector<SlotPair> listedPairs(sim::Simulation& simulation);

bool asleep(const sim::State& state, std::uint32_t id);
std::uint32_t sleepers(const sim::State& state);
bool allFinite(const sim::State& state);

}  // namespace spherule::physics

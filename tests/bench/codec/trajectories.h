#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "compute/device.h"

namespace spherule::bench {

// Frames with the positions (m) of all spheres, in id order, relative to the centre of the bounds.
struct Trajectory {
    std::string name;
    std::uint32_t spheres = 0;
    double smallestRadius = 0;  // m
    std::vector<std::vector<glm::vec3>> frames;
};

constexpr double framesPerSecond = 30;

// Simulates a column of spheres of 20 mm +-20 % that collapses in a box. For 50,000 spheres the box is 1.6 m wide;
// other numbers get a box of the same shape. Returns four trajectories:
// - moving: the column falls and splashes;
// - stirred: gravity tilts and turns;
// - settled: the bed at rest, with sleep off;
// - asleep: the settled bed after its spheres have fallen asleep.
//
// Throws std::runtime_error.
std::vector<Trajectory> collapse(compute::Device& device, std::uint32_t spheres);

// Loads the trajectories that `save` has written, so that codecs can be compared without the simulation.
std::vector<Trajectory> load(const std::string& path);
void save(const std::string& path, const std::vector<Trajectory>& trajectories);

}  // namespace spherule::bench

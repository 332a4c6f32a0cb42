#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "compute/device.h"

namespace spherule::bench {

// Positions of all spheres in id order, in m relative to the centre of the bounds, frame after frame.
struct Trajectory {
    std::string name;
    std::uint32_t spheres = 0;
    double smallestRadius = 0;  // m
    std::vector<std::vector<glm::vec3>> frames;
};

constexpr double framesPerSecond = 30;

// A column of spheres of 20 mm +-20 % collapses in a box of 1.6 m (50,000 spheres; other numbers in a box of the same
// shape): `moving` while it falls and splashes, `settled` with sleep off, `stirred` by gravity that tilts and turns,
// `asleep` after the same settled bed has been let to sleep. Runs the simulation; throws what goes wrong as
// std::runtime_error.
std::vector<Trajectory> collapse(compute::Device& device, std::uint32_t spheres);

// The same from a file that `save` wrote, so that codecs can be compared without the simulation.
std::vector<Trajectory> load(const std::string& path);
void save(const std::string& path, const std::vector<Trajectory>& trajectories);

}  // namespace spherule::bench

#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

// Simulations on the device "cpu:1x1" that together launch every kernel, in all models.
namespace spherule::instruments {

// The bits of results, one number for each part of a run.
using Digest = std::vector<std::uint64_t>;

struct Trial {
    std::string name;  // letters, digits and _
    std::function<Digest()> results;
};
std::ostream& operator<<(std::ostream& out, const Trial& trial);  // its name

// Short runs of the scenes of physics/mixtures.h, of crowds, of commands, and of the encoder of frames.
std::vector<Trial> mixtureTrials();

// Some of these trials. Together they launch every kernel.
std::vector<Trial> coveringTrials();

// A trial of each scene that comes with the program, in each model that has its features. It lasts
// SPHERULE_INSTRUMENT_SUBSTEPS substeps. Without this variable these are three, and scenes of more than 20,000 spheres
// have no results.
std::vector<Trial> sceneTrials();

}  // namespace spherule::instruments

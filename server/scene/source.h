#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/memory.h"
#include "scene/check.h"
#include "scene/occupancy.h"
#include "scene/radius_distribution.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

// The input of a group's source. A source returns spheres with position, velocity, spin and radius. readGroup() sets
// the material, and checks that each sphere has a place in the scene.
struct SourceInput {
    std::string field;                          // field of the source: "groups[2].lattice"
    std::optional<RadiusDistribution> radii{};  // of the group
    glm::vec3 velocity{};                       // m/s, of the group
    glm::vec3 spin{};                           // rad/s, of the group
    std::size_t room = 0;                       // spheres that the scene may still take
    Random random;
};

// The line of each sphere in its file, from 1.
using FileLines = std::vector<std::uint32_t>;

// Claims memory for `count` spheres of a source, plus `besides` bytes per sphere. Hold the claim until the spheres are
// allocated. Refuses and returns nullopt if the scene or the memory has no room for them.
std::optional<memory::Claim> checkRoom(Check& check, const SourceInput& input, double count, std::string_view field,
                                       std::size_t besides = 0);

// Returns the group's radii, which live as long as `input`. Refuses if it has none.
const RadiusDistribution& requiredRadii(Check& check, const SourceInput& input);

constexpr std::size_t mostWrongSpheres = 10;  // of a list, whose errors are kept

// `wrong`: gets the numbers of spheres that are refused, in order.
std::vector<Sphere> fromList(Check& check, const v1::List& list, SourceInput input, std::vector<std::size_t>& wrong);

// `bounds`: a region with the whole length of a periodic axis is filled across the seam.
std::vector<Sphere> fromLattice(Check& check, const v1::Lattice& lattice, const Bounds& bounds, SourceInput input);

// Reads the file of the source in `directory`. Errors give places in the file as file:line:column.
std::vector<Sphere> fromCsv(Check& check, const v1::Csv& csv, const std::filesystem::path& directory, SourceInput input,
                            FileLines& lines);
std::vector<Sphere> fromXyz(Check& check, const v1::Xyz& xyz, const std::filesystem::path& directory, SourceInput input,
                            FileLines& lines);
std::vector<Sphere> fromLammps(Check& check, const v1::Lammps& lammps, const std::filesystem::path& directory,
                               SourceInput input, FileLines& lines);

// Places spheres clear of the scene's obstacles and of `taken`, which has the scene's spheres, and adds them to
// `taken`. Packs them where places at random do not suffice, and refuses if they jam. A box with the whole length of a
// periodic axis is filled across the seam. `shapes`: the surroundings of a mesh.
std::vector<Sphere> fromFill(Check& check, const v1::Fill& fill, const ShapeInput& shapes, const Scene& scene,
                             Occupancy& taken, SourceInput input);

}  // namespace spherule::scene

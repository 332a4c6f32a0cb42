#pragma once

#include <string_view>

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

constexpr std::size_t maxMaterials = 64;
constexpr double largestFriction = 100;  // also for rolling and spinning resistance

// Returns the scene's materials; one with the defaults if there are none.
std::vector<Material> readMaterials(Check& check, const google::protobuf::RepeatedPtrField<v1::Material>& messages);

std::vector<MaterialPair> readPairs(Check& check, const google::protobuf::RepeatedPtrField<v1::MaterialPair>& messages,
                                    const std::vector<Material>& materials);

// Returns the index of the material with this name, or of the first if `name` is empty.
std::uint8_t materialNamed(Check& check, const std::string& name, const std::vector<Material>& materials,
                           std::string_view field);

// The parameters of contacts between two materials: the smaller restitution and the geometric mean of the other values.
// A MaterialPair replaces them.
struct ContactParameters {
    double restitution = 0;
    double friction = 0;
    double rollingResistance = 0;
    double spinningResistance = 0;
};

bool hasWalls(const Scene& scene);  // some face of the bounds is closed

// Returns the parameters of all contacts that can occur: between materials of spheres, and between these and materials
// of walls and obstacles.
std::vector<ContactParameters> actingContactParameters(const Scene& scene);

ContactParameters contactParametersBetween(const Scene& scene, std::uint8_t a, std::uint8_t b);

}  // namespace spherule::scene

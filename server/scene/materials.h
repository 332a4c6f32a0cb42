#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

constexpr std::size_t maxMaterials = 64;
constexpr double largestFriction = 100;  // also for rolling and spinning resistance

// Returns the scene's materials; one with the defaults if there are none.
std::vector<Material> readMaterials(Check& check, const google::protobuf::RepeatedPtrField<v1::Material>& messages);

// Reads a material beside others. Its name must differ from theirs, and may be empty only if it is `first`. `field`:
// its place in the message.
Material readMaterial(Check& check, const v1::Material& message, std::span<const Material> others, bool first,
                      const std::string& field);

// Reads the values between two materials.
MaterialPair readPair(Check& check, const v1::MaterialPair& message, const std::vector<Material>& materials,
                      const std::string& field);

// Returns true if the pair is of the same two materials.
bool samePair(const MaterialPair& one, const MaterialPair& other);

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

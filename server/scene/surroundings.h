#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

struct ShapeInput;

// Returns true if nothing is wrong with the place of the bounds. Otherwise nothing can be placed in them.
bool areBoundsKnown(const Check& check);

Bounds readBounds(Check& check, const v1::Bounds& message, const std::vector<Material>& materials,
                  std::string_view field);
// An obstacle that is refused has no shape.
Obstacle readObstacle(Check& check, const v1::Obstacle& message, const std::vector<Material>& materials,
                      const ShapeInput& input, const std::string& field);
std::vector<Obstacle> readObstacles(Check& check, const google::protobuf::RepeatedPtrField<v1::Obstacle>& messages,
                                    const std::vector<Material>& materials, const ShapeInput& input);

// Refuses meshes with more planes, edges and corners than contacts can be numbered for.
void checkMeshParts(Check& check, const std::vector<Obstacle>& obstacles);

// Refuses bounds in which float32 positions, relative to the centre, are coarser than 1e-4 of the smallest radius
// (`smallest`, m). Also refuses round obstacles so large that distances from them would be as coarse. `field`: of the
// bounds.
void checkResolution(Check& check, const Scene& scene, double smallest, std::string_view field);

// The largest allowed depth of a sphere in a face or an obstacle, as a share of its radius. It covers the rounding of
// decimal figures and of the radius to float32.
constexpr double touchTolerance = 1e-6;

// Returns why a sphere cannot be at `centre` ("reaches x = -0.1, outside the bounds, which are 0 to 5"); nullopt if it
// can. Open faces count like closed ones: spheres may leave through them later, but start inside. Along a periodic
// axis, only the centre must be inside.
std::optional<std::string> whyOutside(const Bounds& bounds, const glm::dvec3& centre, double radius);

// Returns the first obstacle that a sphere reaches into at the scene's time; nullopt if there is none.
std::optional<std::size_t> obstacleAt(const Scene& scene, const glm::dvec3& centre, double radius);

// Writes the obstacle in the form in which scenes give it, without its material.
void writeObstacle(v1::Obstacle& message, const Obstacle& obstacle);

}  // namespace spherule::scene

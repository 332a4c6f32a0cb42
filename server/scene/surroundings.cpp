#include "scene/surroundings.h"

#include <spdlog/fmt/fmt.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

#include "scene/load.h"
#include "scene/materials.h"
#include "scene/mesh/mesh.h"
#include "scene/periodic_axes.h"
#include "scene/shapes.h"

namespace spherule::scene {

namespace {

// Contacts with them are numbered in float32, exactly up to 2^24.
constexpr std::size_t mostMeshParts = 16'700'000;

}  // namespace

bool areBoundsKnown(const Check& check) {
    return check.isRight("bounds.min") && check.isRight("bounds.max") && check.isRight("bounds.periodic");
}

Bounds readBounds(Check& check, const v1::Bounds& message, const std::vector<Material>& materials,
                  std::string_view field) {
    Bounds bounds;
    const Box box = check.box(message.min(), message.max(), field);
    bounds.min = box.min;
    bounds.max = box.max;
    check.entries(
        at(field, "open"), static_cast<std::size_t>(message.open_size()), [&](std::size_t k, const auto& place) {
            const int face = message.open(static_cast<int>(k)) - v1::X_MIN;
            if (face >= XMin && face <= ZMax) {
                bounds.open[static_cast<std::size_t>(face)] = true;
            } else {
                check.refuse(
                    place, fmt::format("is {}, must be X_MIN, X_MAX, Y_MIN, Y_MAX, Z_MIN or Z_MAX", face + v1::X_MIN));
            }
        });
    check.part([&] { readPeriodicAxes(check, message, field, bounds); });
    bounds.material = materialNamed(check, message.material(), materials, at(field, "material"));
    return bounds;
}

Obstacle readObstacle(Check& check, const v1::Obstacle& message, const std::vector<Material>& materials,
                      const ShapeInput& input, const std::string& field) {
    Obstacle obstacle;
    const bool placed = check.part([&] { obstacle.shape = readShape(check, message, field, input); });
    obstacle.material = materialNamed(check, message.material(), materials, at(field, "material"));
    obstacle.colour = check.colour(message.colour(), at(field, "colour"));
    const bool moved = !message.has_motion() || check.part([&] {
        // A shape is turned and moved about the origin of its coordinates.
        const glm::dvec3 origin =
            placed ? check.vectorOr(message.translation(), {}, at(field, "translation")) : glm::dvec3();
        obstacle.motion = readMotion(check, message.motion(), origin, at(field, "motion"));
    });
    if (!placed || !moved || check.isDoubtful(field)) obstacle.shape = nullptr;
    return obstacle;
}

std::vector<Obstacle> readObstacles(Check& check, const google::protobuf::RepeatedPtrField<v1::Obstacle>& messages,
                                    const std::vector<Material>& materials, const ShapeInput& input) {
    std::vector<Obstacle> obstacles;
    const auto count = static_cast<std::size_t>(messages.size());
    if (count > maxObstacles) {
        check.refuse("obstacles", fmt::format("has {} entries, must have at most {}", count, maxObstacles));
        return obstacles;
    }
    check.entries("obstacles", count, [&](std::size_t i, const std::string& field) {
        obstacles.push_back(readObstacle(check, messages[static_cast<int>(i)], materials, input, field));
    });
    if (check.isRight("obstacles")) checkMeshParts(check, obstacles);
    return obstacles;
}

void checkMeshParts(Check& check, const std::vector<Obstacle>& obstacles) {
    std::size_t parts = 0;
    for (std::size_t i = 0; i < obstacles.size() && check.ok(); ++i)
        if (const auto mesh = obstacles[i].shape->mesh()) {
            parts += mesh->parts();
            if (parts > mostMeshParts)
                check.refuse(at("obstacles", i),
                             fmt::format("has {} planes, edges and corners together with the meshes "
                                         "before it, must have at most {}; make them coarser",
                                         parts, mostMeshParts));
        }
}

void checkResolution(Check& check, const Scene& scene, double smallest, std::string_view field) {
    const double allowed = 1e-4 * smallest;
    const glm::dvec3 side = scene.bounds.max - scene.bounds.min;
    const double longest = std::max({side.x, side.y, side.z});
    const double resolution = 0.5 * longest * 0x1p-23;
    if (resolution > allowed)
        check.refuse(
            std::string(field),
            fmt::format("have a side of {} m, where float32 resolves {:.3g} m; the smallest radius of {:.6g} m needs "
                        "{:.3g} m: make them at most {:.6g} m long, or enlarge spheres",
                        longest, resolution, smallest, allowed, allowed * 0x1p24));
    for (std::size_t k = 0; k < scene.obstacles.size(); ++k) {
        const Obstacle& obstacle = scene.obstacles[k];
        // An obstacle that moves lies in a frame about its pivot.
        const glm::dvec3 centre = scene.bounds.centre();
        const double largest = obstacle.motion ? obstacle.shape->largestCoordinate(obstacle.motion->pivot) +
                                                     glm::distance(obstacle.motion->pivot, centre)
                                               : obstacle.shape->largestCoordinate(centre);
        if (largest * 0x1p-23 > allowed)
            check.refuse(
                at("obstacles", k),
                fmt::format("reaches {:.6g} m from the centre of the bounds, where float32 resolves {:.3g} m; the "
                            "smallest radius of {:.6g} m needs {:.3g} m: make it smaller, or enlarge spheres",
                            largest, largest * 0x1p-23, smallest, allowed));
    }
}

std::optional<std::string> whyOutside(const Bounds& bounds, const glm::dvec3& centre, double radius) {
    constexpr const char* axes[] = {"x", "y", "z"};
    const double slack = touchTolerance * radius;
    for (int axis = 0; axis < 3; ++axis) {
        if (bounds.periodic[static_cast<std::size_t>(axis)]) {
            if (centre[axis] >= bounds.min[axis] && centre[axis] <= bounds.max[axis]) continue;
            return fmt::format("has its centre at {} = {:.6g}, outside the bounds, which are {} to {}", axes[axis],
                               centre[axis], bounds.min[axis], bounds.max[axis]);
        }
        const double low = centre[axis] - radius;
        const double high = centre[axis] + radius;
        const bool below = low < bounds.min[axis] - slack;
        if (!below && high <= bounds.max[axis] + slack) continue;
        return fmt::format("reaches {} = {:.6g}, outside the bounds, which are {} to {}", axes[axis],
                           below ? low : high, bounds.min[axis], bounds.max[axis]);
    }
    return std::nullopt;
}

std::optional<std::size_t> obstacleAt(const Scene& scene, const glm::dvec3& centre, double radius) {
    const auto reaches = [&](const Obstacle& obstacle) {
        return radius - obstacle.distance(centre, scene.time) > touchTolerance * radius;
    };
    const auto found = std::ranges::find_if(scene.obstacles, reaches);
    if (found == scene.obstacles.end()) return std::nullopt;
    return static_cast<std::size_t>(found - scene.obstacles.begin());
}

double Obstacle::distance(const glm::dvec3& point, double time) const {
    if (shape == nullptr) return std::numeric_limits<double>::infinity();
    return shape->distance(motion ? movedBy(time).inside(point) : point);
}

double Obstacle::largestSpeed(const Bounds& bounds) const {
    if (!motion) return 0;
    double reach = shape->farthest(motion->pivot);
    if (!std::isfinite(reach))
        reach = glm::length(glm::max(glm::abs(bounds.min - motion->pivot), glm::abs(bounds.max - motion->pivot)));
    return motion->speeds().at(reach);
}

bool anyMoves(const std::vector<Obstacle>& obstacles) {
    return std::ranges::any_of(obstacles, [](const Obstacle& one) { return one.motion.has_value(); });
}

void writeObstacle(v1::Obstacle& message, const Obstacle& obstacle) {
    obstacle.shape->write(message);
    message.set_colour(obstacle.colour);
    if (obstacle.motion) writeMotion(*message.mutable_motion(), *obstacle.motion);
}

}  // namespace spherule::scene

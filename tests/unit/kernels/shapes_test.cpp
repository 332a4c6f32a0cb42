// The shapes of obstacles in kernels, against formulas in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include "compute/cpu/features.h"
#include "kernels_support.h"

namespace spherule::kernels {
namespace {

using glm::dvec2;
using glm::dvec3;
using Feature = compute::cpu::Features;
constexpr std::uint64_t shapes = Feature::OBSTACLES | Feature::FRAMES | Feature::BOXES | Feature::SPHERE_OBSTACLES |
                                 Feature::CYLINDERS | Feature::CONES | Feature::SHELLS | Feature::CAPSULES;
enum Kind : uint { Box = 1, Sphere, Cylinder, Cone, Shell, Capsule };

// Without a frame, the centre is in the row. With one, it is the frame's origin.
struct Solid {
    layout::Obstacle row;
    double size;       // its largest coordinate relative to its centre, m
    double thickness;  // its smallest dimension, m

    [[nodiscard]] dvec3 centre() const {
        return row.framed != 0 ? dvec3(row.frameX.w, row.frameY.w, row.frameZ.w) : dvec3(glm::vec3(row.a));
    }
};

class Random {
  public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
    // A length of any order of magnitude.
    double length(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
    dvec3 direction() {
        std::normal_distribution<double> normal;
        return glm::normalize(dvec3(normal(engine_), normal(engine_), normal(engine_)));
    }

  private:
    std::mt19937_64 engine_;
};

float single(double value) {
    return static_cast<float>(value);
}

vec4 row(dvec3 xyz, double w) {
    return {glm::vec3(xyz), single(w)};
}

layout::Obstacle obstacle(Kind kind, vec4 a, vec4 b, uint parts = 1) {
    layout::Obstacle made{};
    made.a = a;
    made.b = b;
    made.shape = kind;
    made.parts = parts;
    made.surface = 6;
    return made;
}

Solid boxIn(Random& random) {
    const dvec3 centre = random.uniform(0, 10) * random.direction();
    const dvec3 half(random.length(0.1, 10), random.length(0.1, 10), random.length(0.1, 10));
    return {obstacle(Box, row(centre - half, 0), row(centre + half, 0)), 20, 0.1};
}

Solid sphereIn(Random& random, bool hollow) {
    const double radius = random.length(0.1, 100);
    const dvec3 centre = random.uniform(0, 10) * random.direction();
    return {obstacle(Sphere, row(centre, hollow ? -radius : radius), {}), radius, radius};
}

Solid cylinderIn(Random& random, bool hollow) {
    const double radius = random.length(0.1, 100);
    const double half = random.length(0.1, 100);
    const dvec3 centre = random.uniform(0, 10) * random.direction();
    return {obstacle(Cylinder, row(centre, hollow ? -radius : radius), row(random.direction(), half), hollow ? 3 : 1),
            std::hypot(radius, half), std::min(radius, half)};
}

// Puts a solid around the origin into a frame.
Solid inFrame(Random& random, Solid solid) {
    const dvec3 x = random.direction();
    const dvec3 y = glm::normalize(glm::cross(x, random.direction()));
    const dvec3 origin = random.uniform(0, 10) * random.direction();
    solid.row.frameX = row(x, origin.x);
    solid.row.frameY = row(y, origin.y);
    solid.row.frameZ = row(glm::cross(x, y), origin.z);
    solid.row.framed = 1;
    return solid;
}

Solid turnedBoxIn(Random& random, bool hollow) {
    const dvec3 half(random.length(0.1, 10), random.length(0.1, 10), random.length(0.1, 10));
    return inFrame(random, {obstacle(Box, row(-half, hollow ? -1 : 0), row(half, 0), hollow ? 6 : 1), glm::length(half),
                            2 * std::min({half.x, half.y, half.z})});
}

// The line from one radius to the other, in the plane through the axis.
Solid aroundAxisIn(Random& random, Kind kind, bool hollow) {
    const bool disc = kind == Shell && random.uniform(0, 1) < 0.5;
    const dvec2 radii(random.length(0.1, 100), random.length(0.1, 100));
    const double low = disc && random.uniform(0, 1) < 0.5 ? 0 : std::min(radii.x, radii.y);
    const double high = std::max(radii.x, radii.y);
    // A sphere is pushed back into the corners of a hollow cone, which must not be too narrow for that.
    const double half = disc ? 0 : (hollow ? 0.5 * (high - low) : 0) + random.length(0.1, 100);
    const dvec2 line(high - low, 2 * half);
    const double length = glm::length(line);
    const bool one = kind == Shell ? low == 0 : !hollow;
    return inFrame(random, {obstacle(kind, row({low, high, half}, hollow ? -length : length),
                                     row(dvec3(line.y, -line.x, line.x) / length, line.y / length),
                                     one ? 1 : (kind == Shell ? 5 : 7)),
                            std::hypot(high, half), std::min(low > 0 ? low : high, half > 0 ? half : high)});
}

Solid capsuleIn(Random& random, bool hollow) {
    const double radius = random.length(0.1, 100);
    const double half = random.length(0.1, 100);
    return inFrame(random,
                   {obstacle(Capsule, row({half, 0, 0}, hollow ? -radius : radius), {}), half + radius, radius});
}

double distanceFromLine(dvec2 p, dvec2 from, dvec2 to) {
    const double along = std::clamp(glm::dot(p - from, to - from) / glm::dot(to - from, to - from), 0.0, 1.0);
    return glm::distance(p, from + along * (to - from));
}

// The same for a solid in a frame, where `way` leads from the origin of the frame to the point. A solid around an axis
// is a polygon in the plane through the axis. The point is inside if it is on the inner side of all lines.
double distanceInFrame(const layout::Obstacle& row, dvec3 way) {
    const dvec3 p = glm::transpose(glm::dmat3(dvec3(glm::vec3(row.frameX)), dvec3(glm::vec3(row.frameY)),
                                              dvec3(glm::vec3(row.frameZ)))) *
                    way;
    const double sign = static_cast<double>(row.a.w) < 0 ? -1 : 1;
    if (row.shape == Box) {
        const dvec3 beyond = glm::abs(p) - dvec3(glm::vec3(row.b));
        const double deepest = std::max({beyond.x, beyond.y, beyond.z});
        return sign < 0 ? -deepest : (deepest <= 0 ? deepest : glm::length(glm::max(beyond, dvec3(0))));
    }
    const dvec2 flat(std::hypot(p.x, p.y), p.z);
    if (row.shape == Capsule) {
        const double half = static_cast<double>(row.a.x);
        return sign * distanceFromLine(flat, {0, -half}, {0, half}) - static_cast<double>(row.a.w);
    }
    const double h = static_cast<double>(row.a.z);
    const dvec2 low(row.a.x, -h);
    const dvec2 high(row.a.y, h);
    if (row.shape == Shell) return distanceFromLine(flat, low, high);
    const dvec2 line = glm::normalize(high - low);
    const double deepest = std::max(glm::dot(flat - low, dvec2(line.y, -line.x)), std::abs(flat.y) - h);
    if (sign < 0 || deepest <= 0) return sign * deepest;
    return std::min({distanceFromLine(flat, low, high), distanceFromLine(flat, {0, -h}, low),
                     distanceFromLine(flat, high, {0, h})});
}

// The distance of a point from the solid (m). Finds it in the frame of the shape, as the distance from a rectangle in
// the plane through the axis, or from a box.
double distanceFrom(const Solid& solid, dvec3 point) {
    const layout::Obstacle& row = solid.row;
    const double round = static_cast<double>(row.a.w);
    if (row.framed != 0) return distanceInFrame(row, point - solid.centre());
    const dvec3 way = point - dvec3(glm::vec3(row.a));
    if (row.shape == Sphere) return round < 0 ? -round - glm::length(way) : glm::length(way) - round;
    dvec3 beyond(0);
    if (row.shape == Box) {
        const dvec3 half = 0.5 * (dvec3(glm::vec3(row.b)) - dvec3(glm::vec3(row.a)));
        beyond = glm::abs(way - half) - half;
    } else {
        const dvec3 axis = glm::normalize(dvec3(glm::vec3(row.b)));
        const dvec3 u = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
        const dvec3 v = glm::cross(axis, u);
        const double across = std::hypot(glm::dot(way, u), glm::dot(way, v)) - std::abs(round);
        const double along = std::abs(glm::dot(way, axis)) - static_cast<double>(row.b.w);
        beyond = {across, along, -1e9};
        if (round < 0) return -std::max(across, along);
    }
    const double deepest = std::max({beyond.x, beyond.y, beyond.z});
    return deepest <= 0 ? deepest : glm::length(glm::max(beyond, dvec3(0)));
}

// A place near the surface, in the solid or anywhere around it.
dvec3 placeAround(Random& random, const Solid& solid) {
    return solid.centre() + random.uniform(0, 1.5) * solid.size * random.direction();
}

constexpr std::size_t spheresOfEach = 1000;

// 300 solids with 1,000 spheres each.
std::vector<Solid> solids() {
    Random random(7);
    std::vector<Solid> all;
    for (int k = 0; k < 20; ++k)
        for (const Solid& solid :
             {boxIn(random), sphereIn(random, false), sphereIn(random, true), cylinderIn(random, false),
              cylinderIn(random, true), turnedBoxIn(random, false), turnedBoxIn(random, true),
              aroundAxisIn(random, Cone, false), aroundAxisIn(random, Cone, true), aroundAxisIn(random, Shell, false),
              aroundAxisIn(random, Shell, false), aroundAxisIn(random, Shell, false),
              aroundAxisIn(random, Shell, false), capsuleIn(random, false), capsuleIn(random, true)})
            all.push_back(solid);
    return all;
}

struct Spheres {
    layout::Parameters parameters{};
    std::vector<vec4> position, velocity, spin, listReference;
    std::vector<uint> ids, counters = std::vector<uint>(COUNTER_WORDS);
    std::vector<uint> surfaceSums = std::vector<uint>(1);  // without contact sums nothing is added
    std::vector<uint> obstacleLists{END_OF_LIST, 0, END_OF_LIST, 0, 0};
    std::vector<uvec2> nearObstacles;
    std::vector<float> wallWork;
    std::vector<layout::Obstacle> obstacles;
    std::vector<layout::ContactParams> contactParams = std::vector<layout::ContactParams>(1);

    Spheres(Random& random, const Solid& solid) : obstacles{solid.row} {
        parameters.spheres = spheresOfEach;
        parameters.obstacles = 1;
        parameters.obstacleListWords = static_cast<uint>(obstacleLists.size());
        parameters.materials = 1;
        for (std::size_t k = 0; k < spheresOfEach; ++k) position.push_back(row(placeAround(random, solid), 0));
        velocity.assign(spheresOfEach, vec4(0, 0, 0, 1));
        spin.assign(spheresOfEach, vec4(0));
        listReference = spin;
        ids.resize(spheresOfEach);
        nearObstacles.resize(spheresOfEach);
        wallWork.resize(spheresOfEach);
    }

    void run(std::string_view kernel) {
        launch(kernel,
               {{"position", position},
                {"velocity", velocity},
                {"angularVelocity", spin},
                {"listReference", listReference},
                {"idAndMaterial", ids},
                {"counters", counters},
                {"moverSlots", ids},
                {"surfaceSums", surfaceSums},
                {"obstacles", obstacles},
                {"obstacleLists", obstacleLists},
                {"nearObstacles", nearObstacles},
                {"contactParams", contactParams},
                {"wallWork", wallWork}},
               {.parameters = &parameters, .features = shapes});
    }

    [[nodiscard]] double largestCoordinate(const Solid& solid, std::size_t k) const {
        const double centre = glm::length(solid.centre());
        return std::max({centre, solid.size, glm::length(dvec3(glm::vec3(position[k])))});
    }
};

// The lists hold the distance to an obstacle that they leave out. No sphere of a negative radius has an obstacle
// listed.
TEST(KernelsAsCpp, DistancesFromShapesAreExactToRounding) {
    Random random(8);
    double worst = 0;
    for (const Solid& solid : solids()) {
        Spheres spheres(random, solid);
        spheres.parameters.radius = single(-2 * (solid.size + glm::length(solid.centre())));
        spheres.run("list_obstacles");
        for (std::size_t k = 0; k < spheresOfEach; ++k) {
            const auto room = std::bit_cast<float>(spheres.nearObstacles[k].y);
            const double distance = static_cast<double>(room) + static_cast<double>(spheres.parameters.radius);
            const double expected = distanceFrom(solid, dvec3(glm::vec3(spheres.position[k])));
            worst = std::max(worst, std::abs(distance - expected) / spheres.largestCoordinate(solid, k));
        }
    }
    EXPECT_LT(worst, 1e-6);
    RecordProperty("worst", std::to_string(worst * 1e9) + "e-9");
}

// A push moves a sphere along the normal by its depth, so it shows both.
TEST(KernelsAsCpp, PushesLeaveSpheresOnTheSurfacesOfShapes) {
    Random random(9);
    double worst = 0;
    unsigned pushed = 0;
    for (const Solid& solid : solids()) {
        Spheres spheres(random, solid);
        const double radius = 0.1 * solid.thickness;
        spheres.parameters.radius = single(radius);
        const std::vector<vec4> before = spheres.position;
        // In a corner that is not square, a push out of one side leads into the other.
        for (int pass = solid.row.shape == Cone ? 60 : 1; pass > 0; --pass) spheres.run("walls_impulses");
        for (std::size_t k = 0; k < spheresOfEach; ++k) {
            const dvec3 place(glm::vec3(spheres.position[k]));
            const double start = distanceFrom(solid, dvec3(glm::vec3(before[k])));
            const double tolerance = 1e-6 * spheres.largestCoordinate(solid, k);
            if (start > radius + tolerance) {
                EXPECT_EQ(place, dvec3(glm::vec3(before[k])));
            } else if (start < radius - tolerance) {
                ++pushed;
                worst = std::max(worst,
                                 std::abs(distanceFrom(solid, place) - radius) / spheres.largestCoordinate(solid, k));
            }
        }
    }
    EXPECT_LT(worst, 1e-6);
    RecordProperty("worst", std::to_string(worst * 1e9) + "e-9");
    EXPECT_GT(pushed, 40000U);
}

}  // namespace
}  // namespace spherule::kernels

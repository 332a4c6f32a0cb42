// The shapes of obstacles in kernels, against formulas in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compute/cpu/features.h"
#include "kernels_support.h"

namespace spherule::kernels {
namespace {

using glm::dvec3;
using Feature = compute::cpu::Features;
constexpr std::uint64_t shapes = Feature::OBSTACLES | Feature::BOXES | Feature::SPHERE_OBSTACLES | Feature::CYLINDERS;

struct Solid {
    layout::Obstacle row;
    double size;       // its largest coordinate relative to its centre, m
    double thickness;  // its smallest dimension, m
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

Solid boxIn(Random& random) {
    const dvec3 centre = random.uniform(0, 10) * random.direction();
    const dvec3 half(random.length(0.1, 10), random.length(0.1, 10), random.length(0.1, 10));
    return {
        {.a = row(centre - half, 0), .b = row(centre + half, 0), .shape = 1, .parts = 1, .surface = 6, .material = 0},
        20,
        0.1};
}

Solid sphereIn(Random& random, bool hollow) {
    const double radius = random.length(0.1, 100);
    const dvec3 centre = random.uniform(0, 10) * random.direction();
    return {{.a = row(centre, hollow ? -radius : radius), .b = {}, .shape = 2, .parts = 1, .surface = 6, .material = 0},
            radius,
            radius};
}

Solid cylinderIn(Random& random, bool hollow) {
    const double radius = random.length(0.1, 100);
    const double half = random.length(0.1, 100);
    const dvec3 centre = random.uniform(0, 10) * random.direction();
    return {{.a = row(centre, hollow ? -radius : radius),
             .b = row(random.direction(), half),
             .shape = 3,
             .parts = hollow ? 3U : 1U,
             .surface = 6,
             .material = 0},
            std::hypot(radius, half),
            std::min(radius, half)};
}

// The distance of a point from the solid (m). Finds it in the frame of the shape, as the distance from a rectangle in
// the plane through the axis, or from a box.
double distanceFrom(const Solid& solid, dvec3 point) {
    const layout::Obstacle& row = solid.row;
    const double round = static_cast<double>(row.a.w);
    const dvec3 way = point - dvec3(glm::vec3(row.a));
    if (row.shape == 2) return round < 0 ? -round - glm::length(way) : glm::length(way) - round;
    dvec3 beyond(0);
    if (row.shape == 1) {
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
    const dvec3 centre(glm::vec3(solid.row.a));
    return centre + random.uniform(0, 1.5) * solid.size * random.direction();
}

constexpr std::size_t spheresOfEach = 1000;

// 100 solids with 1,000 spheres each.
std::vector<Solid> solids() {
    Random random(7);
    std::vector<Solid> all;
    for (int k = 0; k < 20; ++k)
        for (const Solid& solid : {boxIn(random), sphereIn(random, false), sphereIn(random, true),
                                   cylinderIn(random, false), cylinderIn(random, true)})
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
                {"surfaceSums", surfaceSums},
                {"obstacles", obstacles},
                {"obstacleLists", obstacleLists},
                {"nearObstacles", nearObstacles},
                {"contactParams", contactParams},
                {"wallWork", wallWork}},
               {.parameters = &parameters, .features = shapes});
    }

    [[nodiscard]] double largestCoordinate(const Solid& solid, std::size_t k) const {
        const double centre = glm::length(dvec3(glm::vec3(solid.row.a)));
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
        spheres.parameters.radius = single(-2 * (solid.size + glm::length(dvec3(glm::vec3(solid.row.a)))));
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
        spheres.run("walls_impulses");
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

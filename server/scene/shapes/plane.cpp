#include <algorithm>
#include <cmath>
#include <limits>

#include <spdlog/fmt/fmt.h>
#include <glm/geometric.hpp>

#include "scene/check.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

// A half-space.
class Plane final : public Shape {
  public:
    Plane(const glm::dvec3& point, const glm::dvec3& normal) : point_(point), normal_(normal) {}

    [[nodiscard]] ShapeKind kind() const override { return ShapeKind::Planes; }
    [[nodiscard]] double distance(const glm::dvec3& point) const override { return glm::dot(point - point_, normal_); }
    [[nodiscard]] std::optional<glm::dvec3> normalOfHalfSpace() const override { return normal_; }
    [[nodiscard]] double farthest(const glm::dvec3& /*from*/) const override {
        return std::numeric_limits<double>::infinity();
    }
    [[nodiscard]] double largestCoordinate(const glm::dvec3& /*origin*/) const override { return 0; }
    [[nodiscard]] Row row(const glm::dvec3& origin) const override {
        return {.a = glm::vec4(glm::dvec4(normal_, glm::dot(normal_, point_ - origin))), .b = glm::vec4(0)};
    }
    void write(v1::Obstacle& message) const override {
        setVector(*message.mutable_plane()->mutable_point(), point_);
        setVector(*message.mutable_plane()->mutable_normal(), normal_);
    }

  private:
    glm::dvec3 point_;
    glm::dvec3 normal_;
};

ShapePointer read(Check& check, const v1::Obstacle& message, const std::string& field, const ShapeInput& /*input*/) {
    constexpr double shortest = 1e-9;
    const v1::Plane& plane = message.plane();
    const glm::dvec3 point = check.vector(plane.point(), at(field, "plane.point"));
    const glm::dvec3 normal = check.vector(plane.normal(), at(field, "plane.normal"));
    const double length = glm::length(normal);
    if (length < shortest)
        check.refuse(at(field, "plane.normal"), fmt::format("is {}, must not be zero", shown(normal)));
    return planeShape(point, length < shortest ? normal : unitVector(normal));
}

}  // namespace

ShapePointer planeShape(const glm::dvec3& point, const glm::dvec3& normal) {
    return std::make_shared<Plane>(point, normal);
}

const ShapeType shapesPlanes{
    .field = v1::Obstacle::kPlane,
    .read = read,
    .example =
        [](double top) {
            return planeShape({0, 0, top}, {0, 0, 1});
        },
};

}  // namespace spherule::scene

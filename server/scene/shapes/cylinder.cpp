#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "scene/check.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

// A solid cylinder, or all space around a hollow one, with both ends closed.
class Cylinder final : public Shape {
  public:
    Cylinder(const glm::dvec3& from, const glm::dvec3& to, double radius, bool hollow)
        : from_(from), to_(to), radius_(radius), hollow_(hollow) {}

    [[nodiscard]] ShapeKind kind() const override { return ShapeKind::Cylinders; }
    // Inside a hollow cylinder, a sphere may touch the side and both ends.
    [[nodiscard]] std::uint32_t parts() const override { return hollow_ ? 3 : 1; }
    [[nodiscard]] double distance(const glm::dvec3& point) const override {
        const glm::dvec3 way = point - centre();
        const double along = glm::dot(way, axis());
        const double beyondSide = glm::length(way - along * axis()) - radius_;
        const double beyondEnd = std::abs(along) - halfLength();
        if (hollow_) return -std::max(beyondSide, beyondEnd);
        if (std::max(beyondSide, beyondEnd) <= 0) return std::max(beyondSide, beyondEnd);
        return glm::length(glm::dvec2(std::max(beyondSide, 0.0), std::max(beyondEnd, 0.0)));
    }
    [[nodiscard]] double farthest(const glm::dvec3& from) const override {
        return glm::distance(centre(), from) + std::hypot(radius_, halfLength());
    }
    [[nodiscard]] Row row(const glm::dvec3& origin) const override {
        return {.a = glm::vec4(glm::dvec4(centre() - origin, hollow_ ? -radius_ : radius_)),
                .b = glm::vec4(glm::dvec4(axis(), halfLength()))};
    }
    void write(v1::Obstacle& message) const override {
        setVector(*message.mutable_cylinder()->mutable_from(), from_);
        setVector(*message.mutable_cylinder()->mutable_to(), to_);
        message.mutable_cylinder()->set_radius(radius_);
        message.mutable_cylinder()->set_hollow(hollow_);
    }

  private:
    [[nodiscard]] glm::dvec3 centre() const { return 0.5 * (from_ + to_); }
    [[nodiscard]] glm::dvec3 axis() const { return glm::normalize(to_ - from_); }
    [[nodiscard]] double halfLength() const { return 0.5 * glm::distance(from_, to_); }

    glm::dvec3 from_;
    glm::dvec3 to_;
    double radius_;
    bool hollow_;
};

ShapePointer read(Check& check, const v1::Obstacle& message, const std::string& field, const ShapeInput& /*input*/) {
    const v1::CylinderShape& cylinder = message.cylinder();
    const Ends ends = readEnds(check, cylinder.from(), cylinder.to(), at(field, "cylinder"));
    const double radius = check.upTo(cylinder.radius(), largestComponent, at(field, "cylinder.radius"), " m");
    if (!cylinder.open()) return std::make_shared<Cylinder>(ends.from, ends.to, radius, cylinder.hollow());
    refuseHollow(check, cylinder.hollow(), at(field, "cylinder.hollow"));
    return openCylinder(ends, radius);
}

}  // namespace

const ShapeType shapesCylinders{
    .field = v1::Obstacle::kCylinder,
    .read = read,
    .example = [](double top) -> ShapePointer {
        return std::make_shared<Cylinder>(glm::dvec3(0, 0, top - 1), glm::dvec3(0, 0, top), 0.5, false);
    },
};

}  // namespace spherule::scene

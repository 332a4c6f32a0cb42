#include <algorithm>
#include <cmath>

#include <spdlog/fmt/fmt.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "scene/check.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

// A thin surface around an axis, whose both sides are free: a disc, or the side of a cylinder or cone without ends.
class Shell final : public Shape {
  public:
    enum class Form : std::uint8_t { Disc, Cylinder, Cone };

    // `along`: the axis.
    Shell(Form form, const Ends& along, double low, double high) : form_(form), along_(along), low_(low), high_(high) {}
    // A disc. `normal`: of unit length.
    Shell(const glm::dvec3& centre, const glm::dvec3& normal, double hole, double radius)
        : form_(Form::Disc),
          along_{centre - 0.5 * normal, centre + 0.5 * normal},
          low_(hole),
          high_(radius),
          centre_(centre),
          normal_(normal) {}

    [[nodiscard]] ShapeKind kind() const override { return ShapeKind::Shells; }
    // A sphere in it may touch it all around.
    [[nodiscard]] std::uint32_t parts() const override {
        return form_ == Form::Disc && low_ == 0 ? 1 : partsAroundAxis;
    }
    [[nodiscard]] double distance(const glm::dvec3& point) const override {
        const glm::dvec3 x = along_.frame().inside(point);
        const glm::dvec2 p(std::sqrt(x.x * x.x + x.y * x.y), x.z);
        const glm::dvec2 from(low_, -half());
        const glm::dvec2 line = glm::dvec2(high_, half()) - from;
        return glm::distance(p, from + std::clamp(glm::dot(p - from, line) / glm::dot(line, line), 0.0, 1.0) * line);
    }
    [[nodiscard]] double farthest(const glm::dvec3& from) const override {
        return glm::distance(along_.centre(), from) + std::hypot(std::max(low_, high_), half());
    }
    [[nodiscard]] Row row(const glm::dvec3& origin) const override {
        const glm::dvec2 line(high_ - low_, 2 * half());
        const double length = glm::length(line);
        Frame frame = along_.frame();
        frame.origin -= origin;
        return {.a = glm::vec4(glm::dvec4(low_, high_, half(), length)),
                .b = glm::vec4(glm::dvec4(line.y, -line.x, line.x, line.y) / length),
                .frame = frame};
    }
    void write(v1::Obstacle& message) const override {
        if (form_ == Form::Disc) {
            v1::DiscShape& disc = *message.mutable_disc();
            setVector(*disc.mutable_centre(), centre_);
            setVector(*disc.mutable_normal(), normal_);
            disc.set_radius(high_);
            disc.set_hole(low_);
        } else if (form_ == Form::Cylinder) {
            v1::CylinderShape& cylinder = *message.mutable_cylinder();
            setVector(*cylinder.mutable_from(), along_.from);
            setVector(*cylinder.mutable_to(), along_.to);
            cylinder.set_radius(low_);
            cylinder.set_open(true);
        } else {
            v1::ConeShape& cone = *message.mutable_cone();
            setVector(*cone.mutable_from(), along_.from);
            setVector(*cone.mutable_to(), along_.to);
            cone.set_from_radius(low_);
            cone.set_to_radius(high_);
            cone.set_open(true);
        }
    }

  private:
    [[nodiscard]] double half() const { return form_ == Form::Disc ? 0 : along_.half(); }

    Form form_;
    Ends along_;
    double low_;  // radii (m)
    double high_;
    glm::dvec3 centre_{};  // of a disc, as scenes give it
    glm::dvec3 normal_{};
};

ShapePointer readDisc(Check& check, const v1::Obstacle& message, const std::string& field,
                      const ShapeInput& /*input*/) {
    const v1::DiscShape& disc = message.disc();
    const std::string here = at(field, "disc");
    const glm::dvec3 centre = check.vector(disc.centre(), at(here, "centre"));
    glm::dvec3 normal = check.vector(disc.normal(), at(here, "normal"));
    if (!(glm::length(normal) > 0)) {
        check.refuse(at(here, "normal"), "is zero, must have a direction");
        normal = {0, 0, 1};
    }
    const double radius = check.upTo(disc.radius(), largestComponent, at(here, "radius"), " m");
    const double hole = check.within(disc.hole(), 0, largestComponent, at(here, "hole"), " m");
    if (check.ok() && hole >= radius)
        check.refuse(at(here, "hole"), fmt::format("is {} m, must be below the radius of {} m", hole, radius));
    return std::make_shared<Shell>(centre, unitVector(normal), hole, radius);
}

}  // namespace

ShapePointer openCone(const Ends& ends, double fromRadius, double toRadius) {
    return std::make_shared<Shell>(Shell::Form::Cone, ends, fromRadius, toRadius);
}

ShapePointer openCylinder(const Ends& ends, double radius) {
    return std::make_shared<Shell>(Shell::Form::Cylinder, ends, radius, radius);
}

const ShapeType shapesShells{
    .field = v1::Obstacle::kDisc,
    .read = readDisc,
    .example =
        [](double top) {
            return openCylinder({{0, 0, top - 1}, {0, 0, top}}, 0.5);
        },
};

}  // namespace spherule::scene

#include <glm/geometric.hpp>

#include "scene/check.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

// A solid sphere, or all space around a hollow one.
class SphereShape final : public Shape {
  public:
    SphereShape(const glm::dvec3& centre, double radius, bool hollow)
        : centre_(centre), radius_(radius), hollow_(hollow) {}

    [[nodiscard]] ShapeKind kind() const override { return ShapeKind::SphereObstacles; }
    [[nodiscard]] double distance(const glm::dvec3& point) const override {
        const double outside = glm::distance(point, centre_) - radius_;
        return hollow_ ? -outside : outside;
    }
    [[nodiscard]] double farthest(const glm::dvec3& from) const override {
        return glm::distance(centre_, from) + radius_;
    }
    [[nodiscard]] Row row(const glm::dvec3& origin) const override {
        return {.a = glm::vec4(glm::dvec4(centre_ - origin, hollow_ ? -radius_ : radius_)), .b = glm::vec4(0)};
    }
    void write(v1::Obstacle& message) const override {
        setVector(*message.mutable_sphere()->mutable_centre(), centre_);
        message.mutable_sphere()->set_radius(radius_);
        message.mutable_sphere()->set_hollow(hollow_);
    }

  private:
    glm::dvec3 centre_;
    double radius_;
    bool hollow_;
};

ShapePointer read(Check& check, const v1::Obstacle& message, const std::string& field, const ShapeInput& /*input*/) {
    const v1::SphereShape& sphere = message.sphere();
    const glm::dvec3 centre = check.vector(sphere.centre(), at(field, "sphere.centre"));
    const double radius = check.upTo(sphere.radius(), largestComponent, at(field, "sphere.radius"), " m");
    return std::make_shared<SphereShape>(centre, radius, sphere.hollow());
}

}  // namespace

const ShapeType shapesSphereObstacles{
    .field = v1::Obstacle::kSphere,
    .read = read,
    .example = [](double top) -> ShapePointer {
        return std::make_shared<SphereShape>(glm::dvec3(0, 0, top - 0.5), 0.5, false);
    },
};

}  // namespace spherule::scene

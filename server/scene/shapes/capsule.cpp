#include <algorithm>

#include <glm/geometric.hpp>

#include "scene/check.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

// All points within a distance of a line, or all space around them.
class Capsule final : public Shape {
  public:
    Capsule(const Ends& ends, double radius, bool hollow) : ends_(ends), radius_(radius), hollow_(hollow) {}

    [[nodiscard]] ShapeKind kind() const override { return ShapeKind::Capsules; }
    [[nodiscard]] double distance(const glm::dvec3& point) const override {
        const glm::dvec3 line = ends_.to - ends_.from;
        const double along = std::clamp(glm::dot(point - ends_.from, line) / glm::dot(line, line), 0.0, 1.0);
        const double outside = glm::distance(point, ends_.from + along * line) - radius_;
        return hollow_ ? -outside : outside;
    }
    [[nodiscard]] double farthest(const glm::dvec3& from) const override {
        return glm::distance(ends_.centre(), from) + ends_.half() + radius_;
    }
    [[nodiscard]] Row row(const glm::dvec3& origin) const override {
        Frame frame = ends_.frame();
        frame.origin -= origin;
        return {.a = glm::vec4(glm::dvec4(ends_.half(), 0, 0, hollow_ ? -radius_ : radius_)), .frame = frame};
    }
    void write(v1::Obstacle& message) const override {
        v1::CapsuleShape& capsule = *message.mutable_capsule();
        setVector(*capsule.mutable_from(), ends_.from);
        setVector(*capsule.mutable_to(), ends_.to);
        capsule.set_radius(radius_);
        capsule.set_hollow(hollow_);
    }

  private:
    Ends ends_;
    double radius_;
    bool hollow_;
};

}  // namespace

const ShapeType shapesCapsules{
    .field = v1::Obstacle::kCapsule,
    .read = [](Check& check, const v1::Obstacle& message, const std::string& field,
               const ShapeInput& /*input*/) -> ShapePointer {
        const v1::CapsuleShape& capsule = message.capsule();
        const Ends ends = readEnds(check, capsule.from(), capsule.to(), at(field, "capsule"));
        const double radius = check.upTo(capsule.radius(), largestComponent, at(field, "capsule.radius"), " m");
        return std::make_shared<Capsule>(ends, radius, capsule.hollow());
    },
    .example = [](double top) -> ShapePointer {
        return std::make_shared<Capsule>(Ends{{0, 0, top - 1}, {0, 0, top - 0.2}}, 0.2, false);
    },
};

}  // namespace spherule::scene

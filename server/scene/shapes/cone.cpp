#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "scene/check.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

// A solid truncated cone, or all space around a hollow one, with both ends closed.
class Cone final : public Shape {
  public:
    Cone(const Ends& ends, double fromRadius, double toRadius, bool hollow)
        : ends_(ends), low_(fromRadius), high_(toRadius), hollow_(hollow) {}

    [[nodiscard]] ShapeKind kind() const override { return ShapeKind::Cones; }
    // Inside a hollow cone, a sphere may touch both ends, and the side all around.
    [[nodiscard]] std::uint32_t parts() const override { return hollow_ ? partsAroundAxis + 2 : 1; }
    [[nodiscard]] double distance(const glm::dvec3& point) const override {
        const glm::dvec3 x = ends_.frame().inside(point);
        const glm::dvec2 p(std::sqrt(x.x * x.x + x.y * x.y), x.z);
        const double h = ends_.half();
        const glm::dvec2 corners[] = {{0, -h}, {low_, -h}, {high_, h}, {0, h}};
        const glm::dvec2 side = corners[2] - corners[1];
        const double beyondSide = glm::dot(p - corners[1], glm::dvec2(side.y, -side.x)) / glm::length(side);
        const double deepest = std::max(beyondSide, std::abs(p.y) - h);
        if (hollow_) return -deepest;
        if (deepest <= 0) return deepest;
        double nearest = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k) {
            const glm::dvec2 edge = corners[k + 1] - corners[k];
            const double along = std::clamp(glm::dot(p - corners[k], edge) / glm::dot(edge, edge), 0.0, 1.0);
            if (glm::length(edge) > 0) nearest = std::min(nearest, glm::distance(p, corners[k] + along * edge));
        }
        return nearest;
    }
    [[nodiscard]] double farthest(const glm::dvec3& from) const override {
        return glm::distance(ends_.centre(), from) + std::hypot(std::max(low_, high_), ends_.half());
    }
    [[nodiscard]] Row row(const glm::dvec3& origin) const override {
        const glm::dvec2 side(high_ - low_, 2 * ends_.half());
        const double length = glm::length(side);
        Frame frame = ends_.frame();
        frame.origin -= origin;
        return {.a = glm::vec4(glm::dvec4(low_, high_, ends_.half(), hollow_ ? -length : length)),
                .b = glm::vec4(glm::dvec4(side.y, -side.x, side.x, side.y) / length),
                .frame = frame};
    }
    void write(v1::Obstacle& message) const override {
        v1::ConeShape& cone = *message.mutable_cone();
        setVector(*cone.mutable_from(), ends_.from);
        setVector(*cone.mutable_to(), ends_.to);
        cone.set_from_radius(low_);
        cone.set_to_radius(high_);
        cone.set_hollow(hollow_);
    }

  private:
    Ends ends_;
    double low_;
    double high_;
    bool hollow_;
};

ShapePointer read(Check& check, const v1::Obstacle& message, const std::string& field, const ShapeInput& /*input*/) {
    const v1::ConeShape& cone = message.cone();
    const std::string here = at(field, "cone");
    const Ends ends = readEnds(check, cone.from(), cone.to(), here);
    const double low = check.within(cone.from_radius(), 0, largestComponent, at(here, "fromRadius"), " m");
    const double high = check.within(cone.to_radius(), 0, largestComponent, at(here, "toRadius"), " m");
    if (!(std::max(low, high) > 0)) check.refuse(at(here, "fromRadius"), "is 0, as `toRadius`; one must be above 0");
    if (!cone.open()) return std::make_shared<Cone>(ends, low, high, cone.hollow());
    refuseHollow(check, cone.hollow(), at(here, "hollow"));
    return openCone(ends, low, high);
}

}  // namespace

const ShapeType shapesCones{
    .field = v1::Obstacle::kCone,
    .read = read,
    .example = [](double top) -> ShapePointer {
        return std::make_shared<Cone>(Ends{{0, 0, top - 1}, {0, 0, top}}, 0.5, 0.2, false);
    },
};

}  // namespace spherule::scene

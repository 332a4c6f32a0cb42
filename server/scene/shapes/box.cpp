#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/check.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

// A box along the axes, or all space around a hollow one.
class BoxShape final : public Shape {
  public:
    BoxShape(const Box& box, bool hollow) : box_(box), hollow_(hollow) {}

    [[nodiscard]] ShapeKind kind() const override { return ShapeKind::Boxes; }
    // Inside a hollow box, a sphere may touch all faces.
    [[nodiscard]] std::uint32_t parts() const override { return hollow_ ? faceCount : 1; }
    [[nodiscard]] double distance(const glm::dvec3& point) const override {
        const glm::dvec3 beyond = glm::max(box_.min - point, point - box_.max);  // negative inside
        const double deepest = std::max({beyond.x, beyond.y, beyond.z});
        if (hollow_) return -deepest;
        return deepest > 0 ? glm::length(glm::max(beyond, glm::dvec3(0))) : deepest;
    }
    [[nodiscard]] double farthest(const glm::dvec3& from) const override {
        return glm::length(glm::max(glm::abs(box_.min - from), glm::abs(box_.max - from)));
    }
    // Kernels compare the coordinates of spheres with the faces.
    [[nodiscard]] double largestCoordinate(const glm::dvec3& /*origin*/) const override { return 0; }
    [[nodiscard]] Row row(const glm::dvec3& origin) const override {
        return {.a = glm::vec4(glm::dvec4(box_.min - origin, hollow_ ? -1 : 0)),
                .b = glm::vec4(glm::dvec4(box_.max - origin, 0))};
    }
    void write(v1::Obstacle& message) const override {
        setVector(*message.mutable_box()->mutable_min(), box_.min);
        setVector(*message.mutable_box()->mutable_max(), box_.max);
        message.mutable_box()->set_hollow(hollow_);
    }

  private:
    Box box_;
    bool hollow_;
};

}  // namespace

ShapePointer boxShape(const Box& box, bool hollow) {
    return std::make_shared<BoxShape>(box, hollow);
}

const ShapeType shapesBoxes{
    .field = v1::Obstacle::kBox,
    .read =
        [](Check& check, const v1::Obstacle& message, const std::string& field, const ShapeInput& /*input*/) {
            return boxShape(check.box(message.box().min(), message.box().max(), at(field, "box")),
                            message.box().hollow());
        },
    .example =
        [](double top) {
            return boxShape({.min = {0, 0, top - 1}, .max = {1, 1, top}});
        },
};

}  // namespace spherule::scene

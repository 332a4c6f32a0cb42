#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/check.h"
#include "scene/shapes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

// A box along the axes.
class BoxShape final : public Shape {
  public:
    explicit BoxShape(const Box& box) : box_(box) {}

    [[nodiscard]] ShapeKind kind() const override { return ShapeKind::Boxes; }
    [[nodiscard]] double distance(const glm::dvec3& point) const override {
        const glm::dvec3 beyond = glm::max(box_.min - point, point - box_.max);  // negative inside
        const double deepest = std::max({beyond.x, beyond.y, beyond.z});
        return deepest > 0 ? glm::length(glm::max(beyond, glm::dvec3(0))) : deepest;
    }
    [[nodiscard]] Row row(const glm::dvec3& origin) const override {
        return {.a = glm::vec4(glm::dvec4(box_.min - origin, 0)), .b = glm::vec4(glm::dvec4(box_.max - origin, 0))};
    }
    void write(v1::Obstacle& message) const override {
        setVector(*message.mutable_box()->mutable_min(), box_.min);
        setVector(*message.mutable_box()->mutable_max(), box_.max);
    }

  private:
    Box box_;
};

}  // namespace

ShapePointer boxShape(const Box& box) {
    return std::make_shared<BoxShape>(box);
}

const ShapeType shapesBoxes{
    .field = v1::Obstacle::kBox,
    .read =
        [](Check& check, const v1::Obstacle& message, const std::string& field) {
            return boxShape(check.box(message.box().min(), message.box().max(), at(field, "box")));
        },
    .example =
        [](double top) {
            return boxShape({.min = {0, 0, top - 1}, .max = {1, 1, top}});
        },
};

}  // namespace spherule::scene

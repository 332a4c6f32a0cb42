#include "scene/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <spdlog/fmt/fmt.h>
#include <glm/geometric.hpp>

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

constexpr std::array types = {
#define SHAPE(flag, Name, text, number, function) &shapes##Name,
#include "shapes.def"
#undef SHAPE
    &shapesHeightFields,
};

// Kernels have the numbers, and C++ counts.
#define SHAPE(flag, Name, text, number, function) static_assert(static_cast<unsigned>(ShapeKind::Name) == (number));
#include "shapes.def"
#undef SHAPE

// A shape that is turned, then moved.
class Placed final : public Shape {
  public:
    Placed(ShapePointer shape, const Rotation& rotation, const glm::dvec3& translation)
        : shape_(std::move(shape)), rotation_(rotation), frame_{glm::mat3_cast(rotation.quaternion()), translation} {}

    [[nodiscard]] ShapeKind kind() const override { return shape_->kind(); }
    [[nodiscard]] std::uint32_t parts() const override { return shape_->parts(); }
    [[nodiscard]] double distance(const glm::dvec3& point) const override {
        return shape_->distance(frame_.inside(point));
    }
    [[nodiscard]] std::optional<glm::dvec3> normalOfHalfSpace() const override {
        const std::optional<glm::dvec3> normal = shape_->normalOfHalfSpace();
        if (!normal) return std::nullopt;
        return frame_.turn * *normal;
    }
    [[nodiscard]] double farthest(const glm::dvec3& from) const override {
        return shape_->farthest(frame_.inside(from));
    }
    [[nodiscard]] std::shared_ptr<const Mesh> mesh() const override { return shape_->mesh(); }
    [[nodiscard]] double largestCoordinate(const glm::dvec3& origin) const override {
        if (normalOfHalfSpace()) return 0;  // it needs no frame
        return shape_->largestCoordinate(glm::dvec3(0)) + glm::distance(frame_.origin, origin);
    }
    [[nodiscard]] Row row(const glm::dvec3& origin) const override {
        // A half-space needs no frame: it is given by its normal.
        if (const std::optional<glm::dvec3> normal = normalOfHalfSpace())
            return planeShape(origin - distance(origin) * *normal, *normal)->row(origin);
        Row row = shape_->row(glm::dvec3(0));
        const Frame placed{frame_.turn, frame_.origin - origin};
        row.frame = row.frame ? placed * *row.frame : placed;
        return row;
    }
    [[nodiscard]] const ShapePointer& shape() const { return shape_; }
    [[nodiscard]] const Frame& frame() const { return frame_; }
    void write(v1::Obstacle& message) const override {
        shape_->write(message);
        writePlace(message);
    }
    void writePlace(v1::Obstacle& message) const override {
        writeRotation(*message.mutable_rotation(), rotation_);
        setVector(*message.mutable_translation(), frame_.origin);
    }

  private:
    ShapePointer shape_;
    Rotation rotation_;
    Frame frame_;
};

ShapePointer readPlace(Check& check, const v1::Obstacle& message, const std::string& field, ShapePointer shape) {
    if (!message.has_rotation() && message.translation().empty()) return shape;
    const std::string rotationField = at(field, "rotation");
    const Rotation rotation =
        message.has_rotation() ? readRotation(check, message.rotation(), rotationField) : Rotation{};
    const glm::dvec3 to = check.vectorOr(message.translation(), {}, at(field, "translation"));
    return placedShape(std::move(shape), rotation, to);
}

std::string fieldNames() {
    const auto* const shapes = v1::Obstacle::descriptor()->FindOneofByName("shape");
    std::string names = shapes->field(0)->json_name();
    for (int k = 1; k < shapes->field_count(); ++k) names += ", " + shapes->field(k)->json_name();
    return names;
}

}  // namespace

ShapePointer readShape(Check& check, const v1::Obstacle& message, const std::string& field, const ShapeInput& input) {
    for (const ShapeType* type : types)
        if (type->field == message.shape_case())
            return readPlace(check, message, field, type->read(check, message, field, input));
    check.refuse(field, fmt::format("has no shape, must have one of {}", fieldNames()));
    return nullptr;
}

ShapePointer placedShape(ShapePointer shape, const Rotation& rotation, const glm::dvec3& translation) {
    return std::make_shared<Placed>(std::move(shape), rotation, translation);
}

ShapePointer movedShape(const ShapePointer& shape, const Frame& by) {
    const auto* const placed = dynamic_cast<const Placed*>(shape.get());
    const Frame frame = placed != nullptr ? by * placed->frame() : by;
    const glm::dquat turn = glm::normalize(glm::quat_cast(frame.turn));
    return placedShape(placed != nullptr ? placed->shape() : shape, Rotation::of(turn), frame.origin);
}

glm::dvec3 originOf(const Shape& shape) {
    const auto* const placed = dynamic_cast<const Placed*>(&shape);
    return placed != nullptr ? placed->frame().origin : glm::dvec3(0);
}

double Ends::half() const {
    return 0.5 * glm::distance(from, to);
}

Frame Ends::frame() const {
    const glm::dvec3 z = glm::normalize(to - from);
    const glm::dvec3 other = std::abs(z.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(other, z));
    return {glm::dmat3(x, glm::cross(z, x), z), centre()};
}

Ends readEnds(Check& check, const Numbers& from, const Numbers& to, const std::string& field) {
    constexpr double shortest = 1e-9;  // m
    Ends ends{check.vector(from, at(field, "from")), check.vector(to, at(field, "to"))};
    if (glm::distance(ends.from, ends.to) < shortest) {
        check.refuse(at(field, "to"), fmt::format("is {}, must differ from `from`", shown(ends.to)));
        ends.to = ends.from + glm::dvec3(0, 0, 1);
    }
    return ends;
}

glm::dvec3 unitVector(const glm::dvec3& vector) {
    const double length = glm::length(vector);
    return std::abs(length - 1) < 1e-15 ? vector : vector / length;
}

void refuseHollow(Check& check, bool hollow, const std::string& field) {
    if (hollow) check.refuse(field, "is true with `open`, whose both sides are free; leave one of them out");
}

std::uint32_t surfacesOf(const Scene& scene) {
    std::uint32_t surfaces = faceCount;
    for (const Obstacle& obstacle : scene.obstacles) surfaces += obstacle.shape->parts();
    return surfaces;
}

ShapePointer exampleOf(ShapeKind kind, double top) {
    return types.at(static_cast<std::size_t>(kind))->example(top);
}

}  // namespace spherule::scene

#include "scene/fill_region.h"

#include <algorithm>

#include <spdlog/fmt/fmt.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/check.h"
#include "scene/mesh/mesh.h"
#include "scene/periodic_axes.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

ShapePointer readInside(Check& check, const v1::Fill& message, const std::string& field, const ShapeInput& input) {
    const std::string here = at(field, "inMesh");
    refuseForm(check, message.in_mesh().hollow(), at(here, "hollow"));
    v1::Mesh closed = message.in_mesh();
    closed.set_solid(true);
    const Rotation rotation =
        message.has_rotation() ? readRotation(check, message.rotation(), at(field, "rotation")) : Rotation{};
    const glm::dvec3 to = check.vectorOr(message.translation(), {}, at(field, "translation"));
    ShapePointer shape = readMesh(check, closed, here, input);
    if (!shape || (!message.has_rotation() && message.translation().empty())) return shape;
    return placedShape(std::move(shape), rotation, to);
}

Box boxAround(const Shape& shape) {
    const Frame frame = shape.row(glm::dvec3(0)).frame.value();
    Box box{glm::dvec3(largestComponent), glm::dvec3(-largestComponent)};
    for (const glm::dvec3& vertex : shape.mesh()->vertices) {
        const glm::dvec3 place = frame.outside(vertex);
        box = {glm::min(box.min, place), glm::max(box.max, place)};
    }
    return box;
}

void readForm(Check& check, const v1::Fill& message, const std::string& field, const ShapeInput& input,
              FillRegion& region) {
    const auto set = [&](const auto& form) {
        region.form = form;
        region.box = scene::boxAround(form);
        region.volume = volumeOf(form);
    };
    switch (message.region_case()) {
        case v1::Fill::kInSphere:
            return set(readBall(check, message.in_sphere(), at(field, "inSphere")));
        case v1::Fill::kInCylinder:
            return set(readCylinder(check, message.in_cylinder(), at(field, "inCylinder")));
        case v1::Fill::kInMesh: {
            ShapePointer shape = readInside(check, message, field, input);
            if (!shape || !check.ok()) return;
            region.box = boxAround(*shape);
            region.volume = shape->mesh()->volume();
            region.form = std::move(shape);
            return;
        }
        case v1::Fill::REGION_NOT_SET:
            return set(check.box(message.min(), message.max(), field));
    }
}

void checkInside(Check& check, const Box& box, const Bounds& bounds, const std::string& field) {
    constexpr double rounding = 1e-9;  // of a side of the bounds
    constexpr const char* axes[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis) {
        const double slack = rounding * (bounds.max[axis] - bounds.min[axis]);
        const bool below = box.min[axis] < bounds.min[axis] - slack;
        if (!below && box.max[axis] <= bounds.max[axis] + slack) continue;
        check.refuse(
            field, fmt::format("reaches {} = {:.6g}, outside the bounds, which are {} to {}; make the region "
                               "smaller, or the bounds larger",
                               axes[axis], below ? box.min[axis] : box.max[axis], bounds.min[axis], bounds.max[axis]));
    }
}

double inset(const Box& box, const Bounds& bounds, int axis, double radius) {
    return spansPeriod(bounds, box, axis) ? 0 : radius;
}

}  // namespace

FillRegion readFillRegion(Check& check, const v1::Fill& message, const std::string& field, const Bounds& bounds,
                          const ShapeInput& input) {
    FillRegion region;
    if (message.region_case() != v1::Fill::REGION_NOT_SET)
        for (const auto& [name, given] : {std::pair("min", !message.min().empty()), {"max", !message.max().empty()}})
            if (given) check.refuse(at(field, name), "is given with another region; leave one of them out");
    if (!message.has_in_mesh() && message.has_rotation())
        check.refuse(at(field, "rotation"), "is given without `inMesh`; leave it out");
    if (!message.has_in_mesh() && !message.translation().empty())
        check.refuse(at(field, "translation"), "is given without `inMesh`; leave it out");
    if (check.ok()) readForm(check, message, field, input, region);
    if (check.ok()) checkInside(check, region.box, bounds, field);
    return region;
}

std::optional<glm::dvec3> FillRegion::draw(Random& random, const Bounds& bounds, double radius) const {
    if (const auto* const ball = std::get_if<BallRegion>(&form))
        return placeIn(BallRegion{ball->centre, ball->radius - radius}, random);
    if (const auto* const cylinder = std::get_if<CylinderRegion>(&form)) {
        const glm::dvec3 end = radius * glm::normalize(cylinder->to - cylinder->from);
        return placeIn(CylinderRegion{cylinder->from + end, cylinder->to - end, cylinder->radius - radius}, random);
    }
    Box centres = box;
    for (int axis = 0; axis < 3; ++axis) {
        centres.min[axis] += inset(box, bounds, axis, radius);
        centres.max[axis] -= inset(box, bounds, axis, radius);
    }
    const glm::dvec3 place = placeIn(centres, random);
    const auto* const shape = std::get_if<ShapePointer>(&form);
    if (shape != nullptr && (*shape)->distance(place) > -radius) return std::nullopt;
    return place;
}

std::vector<Surface> FillRegion::surfaces(const Bounds& bounds) const {
    std::vector<Surface> all;
    if (std::holds_alternative<Box>(form)) {
        for (int axis = 0; axis < 3; ++axis) {
            if (spansPeriod(bounds, box, axis)) continue;
            all.emplace_back([axis, low = box.min[axis]](const glm::dvec3& x) { return x[axis] - low; });
            all.emplace_back([axis, high = box.max[axis]](const glm::dvec3& x) { return high - x[axis]; });
        }
    } else if (const auto* const ball = std::get_if<BallRegion>(&form)) {
        all.emplace_back([one = *ball](const glm::dvec3& x) { return one.radius - glm::distance(x, one.centre); });
    } else if (const auto* const cylinder = std::get_if<CylinderRegion>(&form)) {
        const glm::dvec3 axis = glm::normalize(cylinder->to - cylinder->from);
        all.emplace_back([axis, from = cylinder->from](const glm::dvec3& x) { return glm::dot(x - from, axis); });
        all.emplace_back([axis, to = cylinder->to](const glm::dvec3& x) { return glm::dot(to - x, axis); });
        all.emplace_back([axis, from = cylinder->from, radius = cylinder->radius](const glm::dvec3& x) {
            const glm::dvec3 way = x - from;
            return radius - glm::length(way - glm::dot(way, axis) * axis);
        });
    } else {
        all.emplace_back([shape = std::get<ShapePointer>(form)](const glm::dvec3& x) { return -shape->distance(x); });
    }
    return all;
}

double FillRegion::largestRadius() const {
    if (const auto* const ball = std::get_if<BallRegion>(&form)) return ball->radius;
    if (const auto* const cylinder = std::get_if<CylinderRegion>(&form))
        return std::min(cylinder->radius, 0.5 * glm::distance(cylinder->from, cylinder->to));
    const glm::dvec3 side = box.max - box.min;
    return 0.5 * std::min({side.x, side.y, side.z});
}

}  // namespace spherule::scene

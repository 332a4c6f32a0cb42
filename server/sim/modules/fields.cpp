#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "sim/modules/module.h"

namespace spherule::sim {

namespace {

constexpr double pi = std::numbers::pi;

// The rows of a field in the parameters (shaders/shared/fields.h), except its kind.
struct FieldRows {
    glm::dvec4 place{};
    glm::dvec4 numbers{};
    glm::dvec4 vector{};
    glm::dvec4 spin{};
};

struct RegionRows {
    glm::dvec4 low{};
    glm::dvec4 high{};
};

FieldRows rowsOf(const scene::Drag& drag, const scene::Scene& scene) {
    FieldRows rows{.place = {0, 0, 0, 0.5 * drag.density * drag.coefficient * pi},
                   .vector = glm::dvec4(drag.velocity, 0),
                   .spin = {0, 0, 0, 1}};
    if (!drag.vortex) return rows;
    constexpr double least = std::numeric_limits<float>::min();
    const double speed = drag.vortex->speed;
    rows.place = glm::dvec4(drag.vortex->centre - scene.bounds.centre(), rows.place.w);
    rows.spin = glm::dvec4(drag.vortex->axis * (speed / drag.vortex->core), std::max(speed * speed, least));
    return rows;
}

FieldRows rowsOf(const scene::Attraction& attraction, const scene::Scene& scene) {
    return {.place = glm::dvec4(attraction.centre - scene.bounds.centre(), attraction.strength),
            .numbers = {attraction.softening * attraction.softening, 0, 0, 0}};
}

FieldRows rowsOf(const scene::Buoyancy& liquid, const scene::Scene& scene) {
    const glm::dvec3& gravity = scene.forces.gravity;
    const double g = glm::length(gravity);
    const glm::dvec3 surface = liquid.surface.value_or(scene::topOf(scene));
    return {.place = glm::dvec4(surface - scene.bounds.centre(), liquid.density * g * pi / 3),
            .numbers = {liquid.surface ? 0.0 : static_cast<double>(BOTTOMLESS), 0, 0, 0},
            .vector = g > 0 ? glm::dvec4(gravity / -g, 0) : glm::dvec4(0)};
}

FieldRows rowsOf(const scene::Spring& spring, const scene::Scene& scene) {
    return {.place = glm::dvec4(spring.centre - scene.bounds.centre(), spring.stiffness),
            .numbers = {spring.damping, 0, 0, 0}};
}

// Far beyond all spheres: a region that does not end.
constexpr double endless = 1e30;  // m

// A box that spans the bounds along a periodic axis does not end there.
RegionRows rowsOf(const scene::Box& box, const scene::Bounds& bounds) {
    RegionRows rows{.low = glm::dvec4(box.min - bounds.centre(), IN_BOX),
                    .high = glm::dvec4(box.max - bounds.centre(), 0)};
    for (int axis = 0; axis < 3; ++axis)
        if (bounds.periodic[static_cast<std::size_t>(axis)]) {
            rows.low[axis] = -endless;
            rows.high[axis] = endless;
        }
    return rows;
}

RegionRows rowsOf(const scene::BallRegion& ball, const scene::Bounds& bounds) {
    return {.low = glm::dvec4(ball.centre - bounds.centre(), endless), .high = {0, 0, 0, ball.radius * ball.radius}};
}

RegionRows rowsOf(const scene::CylinderRegion& cylinder, const scene::Bounds& bounds) {
    const glm::dvec3 way = cylinder.to - cylinder.from;
    return {.low = glm::dvec4(0.5 * (cylinder.from + cylinder.to) - bounds.centre(), 0.5 * glm::length(way)),
            .high = glm::dvec4(glm::normalize(way), cylinder.radius * cylinder.radius)};
}

RegionRows rowsOf(const std::optional<scene::Region>& region, const scene::Bounds& bounds) {
    if (!region) return {.low = {-endless, -endless, -endless, IN_BOX}, .high = {endless, endless, endless, 0}};
    return std::visit([&](const auto& one) { return rowsOf(one, bounds); }, *region);
}

void uploadFields(const ParameterSource& from, layout::Parameters& p) {
    static_assert(scene::maxFields == MOST_FIELDS);
    const auto& fields = from.scene.forces.fields;
    for (std::size_t k = 0; k < fields.size(); ++k) {
        FieldRows rows = std::visit([&](const auto& field) { return rowsOf(field, from.scene); }, fields[k]);
        rows.numbers.w = static_cast<double>(fields[k].index()) + 1;
        p.fieldPlace[k] = glm::vec4(rows.place);
        p.fieldNumbers[k] = glm::vec4(rows.numbers);
        p.fieldVector[k] = glm::vec4(rows.vector);
        p.fieldSpin[k] = glm::vec4(rows.spin);
    }
}

void uploadRegions(const ParameterSource& from, layout::Parameters& p) {
    const auto& fields = from.scene.forces.fields;
    for (std::size_t k = 0; k < fields.size(); ++k) {
        const RegionRows rows = rowsOf(scene::regionOf(fields[k]), from.scene.bounds);
        p.fieldLow[k] = glm::vec4(rows.low);
        p.fieldHigh[k] = glm::vec4(rows.high);
    }
}

template <class Kind>
bool hasAny(const scene::Scene& scene, const Features& /*others*/) {
    return std::ranges::any_of(scene.forces.fields,
                               [](const scene::Field& field) { return std::holds_alternative<Kind>(field); });
}

void addDrag(scene::Scene& scene) {
    scene.forces.fields = {scene::Drag{}};
}

}  // namespace

// Forces on every sphere besides gravity and contacts.
const Module moduleFields{
    .feature = Feature::Fields,
    .required = [](const scene::Scene& scene, const Features& /*others*/) { return !scene.forces.fields.empty(); },
    .upload = uploadFields,
    .cost = {.name = "drag", .with = addDrag},
};

// A medium with drag moves.
const Module moduleFlows{
    .feature = Feature::Flows,
    .required =
        [](const scene::Scene& scene, const Features& /*others*/) {
            return std::ranges::any_of(scene.forces.fields, [](const scene::Field& field) {
                const auto* const drag = std::get_if<scene::Drag>(&field);
                return drag != nullptr && drag->moves();
            });
        },
    .cost = {.name = "wind",
             .without = addDrag,
             .with =
                 [](scene::Scene& scene) {
                     scene.forces.fields = {scene::Drag{.velocity = {0.1, 0, 0}}};
                 }},
};

const Module moduleBuoyancy{
    .feature = Feature::Buoyancy,
    .required = hasAny<scene::Buoyancy>,
    .cost = {.name = "buoyancy",
             .with = [](scene::Scene& scene) { scene.forces.fields = {scene::Buoyancy{.density = 1.2}}; }},
};

// A spring to a point pulls every sphere.
const Module moduleSprings{
    .feature = Feature::Springs,
    .required = hasAny<scene::Spring>,
    .cost = {.name = "a spring",
             .with =
                 [](scene::Scene& scene) {
                     scene.forces.fields = {scene::Spring{.centre = scene.bounds.centre(), .stiffness = 1e-6}};
                 }},
};

// A field acts in a part of the scene.
const Module moduleRegions{
    .feature = Feature::Regions,
    .required =
        [](const scene::Scene& scene, const Features& /*others*/) {
            return std::ranges::any_of(scene.forces.fields,
                                       [](const scene::Field& field) { return scene::regionOf(field).has_value(); });
        },
    .upload = uploadRegions,
    .cost = {.name = "a region of drag",
             .without = addDrag,
             .with =
                 [](scene::Scene& scene) {
                     scene.forces.fields = {scene::Drag{.region = scene::Box{scene.bounds.min, scene.bounds.max}}};
                 }},
};

}  // namespace spherule::sim

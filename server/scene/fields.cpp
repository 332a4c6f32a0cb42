#include "scene/fields.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <spdlog/fmt/fmt.h>
#include <glm/geometric.hpp>

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

constexpr double pi = std::numbers::pi;

constexpr double densest = 1e5;     // kg/m^3
constexpr double fastest = 1e5;     // m/s
constexpr double narrowest = 1e-6;  // m, so that its cube is a normal float
constexpr double widest = 1e9;      // m

Vortex readVortex(Check& check, const v1::Vortex& message, const std::string& field) {
    Vortex vortex;
    vortex.centre = check.vector(message.centre(), at(field, "centre"));
    check.part([&] {
        const glm::dvec3 axis = check.vector(message.axis(), at(field, "axis"));
        if (!(glm::length(axis) > 0)) check.refuse(at(field, "axis"), "is zero, must have a direction");
        if (check.ok()) vortex.axis = glm::normalize(axis);
    });
    vortex.speed = check.within(message.speed(), -fastest, fastest, at(field, "speed"), " m/s");
    vortex.core = check.within(message.core(), narrowest, widest, at(field, "core"), " m");
    return vortex;
}

Field readKind(Check& check, const v1::Drag& message, const std::string& field) {
    constexpr double roughest = 1e3;  // coefficient
    Drag drag;
    if (message.has_density())
        drag.density = check.within(message.density(), 0, densest, at(field, "density"), " kg/m^3");
    if (message.has_coefficient())
        drag.coefficient = check.within(message.coefficient(), 0, roughest, at(field, "coefficient"));
    check.part([&] {
        drag.velocity = check.vectorOr(message.velocity(), glm::dvec3(0), at(field, "velocity"));
        if (glm::length(drag.velocity) > fastest)
            check.refuse(at(field, "velocity"),
                         fmt::format("is {:g} m/s long, at most {:g} is allowed", glm::length(drag.velocity), fastest));
    });
    if (message.has_vortex()) drag.vortex = readVortex(check, message.vortex(), at(field, "vortex"));
    return drag;
}

Field readKind(Check& check, const v1::Attraction& message, const std::string& field) {
    constexpr double strongest = 1e9;  // m^3/s^2
    constexpr double steepest = 1e6;   // m/s^2
    Attraction attraction;
    attraction.centre = check.vector(message.centre(), at(field, "centre"));
    attraction.strength = check.within(message.strength(), -strongest, strongest, at(field, "strength"), " m^3/s^2");
    attraction.softening = check.within(message.softening(), narrowest, widest, at(field, "softening"), " m");
    // The acceleration is largest at softening / sqrt(2).
    const double largest =
        std::abs(attraction.strength) * 2 / (3 * std::numbers::sqrt3) / (attraction.softening * attraction.softening);
    if (largest > steepest)
        check.refuse(field, fmt::format("accelerates spheres near its centre by up to {:.3g} m/s^2, at most {:g} is "
                                        "allowed; use a larger softening or a smaller strength",
                                        largest, steepest));
    return attraction;
}

Field readKind(Check& check, const v1::Buoyancy& message, const std::string& field) {
    Buoyancy liquid;
    if (message.has_density())
        liquid.density = check.within(message.density(), 0, densest, at(field, "density"), " kg/m^3");
    if (!message.surface().empty()) liquid.surface = check.vector(message.surface(), at(field, "surface"));
    return liquid;
}

Field readKind(Check& check, const v1::Spring& message, const std::string& field) {
    constexpr double stiffest = 1e9;     // N/m
    constexpr double mostDamping = 1e9;  // N s/m
    Spring spring;
    spring.centre = check.vector(message.centre(), at(field, "centre"));
    spring.stiffness = check.within(message.stiffness(), 0, stiffest, at(field, "stiffness"), " N/m");
    spring.damping = check.within(message.damping(), 0, mostDamping, at(field, "damping"), " N s/m");
    return spring;
}

std::optional<Region> readRegion(Check& check, const v1::Field& message, const std::string& field) {
    if (message.has_in_box()) {
        const std::string shape = at(field, "inBox");
        refuseForm(check, message.in_box().hollow(), at(shape, "hollow"));
        return check.box(message.in_box().min(), message.in_box().max(), shape);
    }
    if (message.has_in_sphere()) return readBall(check, message.in_sphere(), at(field, "inSphere"));
    if (message.has_in_cylinder()) return readCylinder(check, message.in_cylinder(), at(field, "inCylinder"));
    return std::nullopt;
}

std::optional<Field> readKindOf(Check& check, const v1::Field& message, const std::string& field) {
    switch (message.kind_case()) {
        case v1::Field::kDrag:
            return readKind(check, message.drag(), at(field, "drag"));
        case v1::Field::kAttraction:
            return readKind(check, message.attraction(), at(field, "attraction"));
        case v1::Field::kBuoyancy:
            return readKind(check, message.buoyancy(), at(field, "buoyancy"));
        case v1::Field::kSpring:
            return readKind(check, message.spring(), at(field, "spring"));
        case v1::Field::KIND_NOT_SET:
            break;
    }
    check.refuse(field, "has no kind, must be drag, attraction, buoyancy or spring");
    return std::nullopt;
}

void writeKind(v1::Field& message, const Drag& drag) {
    v1::Drag& to = *message.mutable_drag();
    to.set_density(drag.density);
    to.set_coefficient(drag.coefficient);
    if (drag.velocity != glm::dvec3(0)) setVector(*to.mutable_velocity(), drag.velocity);
    if (!drag.vortex) return;
    setVector(*to.mutable_vortex()->mutable_centre(), drag.vortex->centre);
    setVector(*to.mutable_vortex()->mutable_axis(), drag.vortex->axis);
    to.mutable_vortex()->set_speed(drag.vortex->speed);
    to.mutable_vortex()->set_core(drag.vortex->core);
}

void writeKind(v1::Field& message, const Attraction& attraction) {
    setVector(*message.mutable_attraction()->mutable_centre(), attraction.centre);
    message.mutable_attraction()->set_strength(attraction.strength);
    message.mutable_attraction()->set_softening(attraction.softening);
}

void writeKind(v1::Field& message, const Buoyancy& liquid) {
    message.mutable_buoyancy()->set_density(liquid.density);
    if (liquid.surface) setVector(*message.mutable_buoyancy()->mutable_surface(), *liquid.surface);
}

void writeKind(v1::Field& message, const Spring& spring) {
    setVector(*message.mutable_spring()->mutable_centre(), spring.centre);
    message.mutable_spring()->set_stiffness(spring.stiffness);
    message.mutable_spring()->set_damping(spring.damping);
}

void writeRegion(v1::Field& message, const Box& box) {
    setVector(*message.mutable_in_box()->mutable_min(), box.min);
    setVector(*message.mutable_in_box()->mutable_max(), box.max);
}

void writeRegion(v1::Field& message, const BallRegion& ball) {
    setVector(*message.mutable_in_sphere()->mutable_centre(), ball.centre);
    message.mutable_in_sphere()->set_radius(ball.radius);
}

void writeRegion(v1::Field& message, const CylinderRegion& cylinder) {
    setVector(*message.mutable_in_cylinder()->mutable_from(), cylinder.from);
    setVector(*message.mutable_in_cylinder()->mutable_to(), cylinder.to);
    message.mutable_in_cylinder()->set_radius(cylinder.radius);
}

}  // namespace

glm::dvec3 Drag::velocityAt(const glm::dvec3& place) const {
    if (!vortex) return velocity;
    const glm::dvec3 around = glm::cross(vortex->axis, place - vortex->centre);
    const double distance = glm::length(around);
    const double core = vortex->core;
    return velocity + around * (distance < core ? vortex->speed / core : vortex->speed * core / (distance * distance));
}

const std::optional<Region>& regionOf(const Field& field) {
    return std::visit([](const auto& one) -> const std::optional<Region>& { return one.region; }, field);
}

bool addsEnergy(const Field& field) {
    const auto* const drag = std::get_if<Drag>(&field);
    return drag != nullptr ? drag->moves() : regionOf(field).has_value();
}

double submergedVolume(double radius, double depth) {
    const double h = std::clamp(depth + radius, 0.0, 2 * radius);
    return pi * h * h * (3 * radius - h) / 3;
}

double submergedIntegral(double radius, double depth) {
    const double h = std::clamp(depth + radius, 0.0, 2 * radius);
    const double cap = pi * h * h * h * (4 * radius - h) / 12;
    return cap + 4 * pi / 3 * radius * radius * radius * std::max(depth - radius, 0.0);
}

std::optional<Field> readField(Check& check, const v1::Field& message, const std::string& at) {
    std::optional<Field> field;
    check.part([&] { field = readKindOf(check, message, at); });
    std::optional<Region> region;
    check.part([&] { region = readRegion(check, message, at); });
    if (field) std::visit([&](auto& one) { one.region = region; }, *field);
    return field;
}

std::vector<Field> readFields(Check& check, const v1::Scene& message) {
    std::vector<Field> fields;
    const auto count = static_cast<std::size_t>(message.fields_size());
    if (count > maxFields) {
        check.refuse("fields", fmt::format("has {} entries, must have at most {}", count, maxFields));
        return fields;
    }
    check.entries("fields", count, [&](std::size_t k, const std::string& here) {
        // Each keeps its number, even if one before is refused.
        fields.push_back(readField(check, message.fields(static_cast<int>(k)), here).value_or(Drag()));
    });
    return fields;
}

void writeFields(google::protobuf::RepeatedPtrField<v1::Field>& messages, const std::vector<Field>& fields) {
    for (const Field& field : fields) {
        v1::Field& to = *messages.Add();
        std::visit([&](const auto& one) { writeKind(to, one); }, field);
        if (const auto& region = regionOf(field)) std::visit([&](const auto& one) { writeRegion(to, one); }, *region);
    }
}

}  // namespace spherule::scene

#include "scene/drive.h"

#include <algorithm>
#include <cmath>

#include <spdlog/fmt/fmt.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

double Drive::placeAt(double time) const {
    return std::clamp(place + rate * (time - since), least, most);
}

double Drive::forceAt(const glm::dvec3& gravity, const glm::dvec3& pivot) const {
    if (!turns) return force + mass * glm::dot(gravity, axis);
    const glm::dvec3 arm = glm::angleAxis(place, axis) * (centre - pivot);
    return force + mass * glm::dot(glm::cross(arm, gravity), axis);
}

namespace {

constexpr double largest = 1e12;    // kg, N and so on
constexpr double smallest = 1e-12;  // kg or kg m^2: kernels have its reciprocal as a float

// Returns the axis of unit length. Refuses a drive that has not exactly one.
glm::dvec3 readAxis(Check& check, const v1::Drive& message, const std::string& field) {
    const bool turns = message.about_size() > 0;
    if (turns == (message.along_size() > 0)) {
        check.refuse(field, turns ? "has both `along` and `about`; a body slides or turns"
                                  : "needs `along`, to slide, or `about`, to turn");
        return {0, 0, 1};
    }
    const std::string here = at(field, turns ? "about" : "along");
    const glm::dvec3 axis = check.vector(turns ? message.about() : message.along(), here);
    if (check.ok() && !(glm::length(axis) > 0)) check.refuse(here, "has length zero");
    return check.ok() ? glm::normalize(axis) : glm::dvec3(0, 0, 1);
}

// Refuses members that belong to the other kind of body.
void refuseOthers(Check& check, const v1::Drive& message, bool turns, const std::string& field) {
    const auto refuse = [&](bool given, const char* name) {
        if (given)
            check.refuse(at(field, name), turns ? "is of a body that slides; this one turns (`about`)"
                                                : "is of a body that turns; this one slides (`along`)");
    };
    if (turns) {
        refuse(message.force() != 0, "force");
    } else {
        refuse(message.torque() != 0, "torque");
        refuse(message.inertia() != 0, "inertia");
        refuse(message.centre_size() > 0, "centre");
    }
}

}  // namespace

Drive readDrive(Check& check, const v1::Drive& message, const glm::dvec3& pivot, const std::string& field) {
    Drive drive;
    drive.axis = readAxis(check, message, field);
    if (!check.ok()) return drive;
    drive.turns = message.about_size() > 0;
    refuseOthers(check, message, drive.turns, field);
    const char* const unit = drive.turns ? " rad" : " m";
    const char* const perSecond = drive.turns ? " rad/s" : " m/s";
    if (drive.turns) {
        if (message.mass() != 0) drive.mass = check.within(message.mass(), smallest, largest, at(field, "mass"), " kg");
        drive.inertia = check.within(message.inertia(), smallest, largest, at(field, "inertia"), " kg m^2");
        drive.force = check.within(message.torque(), -largest, largest, at(field, "torque"), " N m");
        drive.centre = check.vectorOr(message.centre(), pivot, at(field, "centre"));
    } else {
        drive.mass = drive.inertia = check.within(message.mass(), smallest, largest, at(field, "mass"), " kg");
        drive.force = check.within(message.force(), -largest, largest, at(field, "force"), " N");
    }
    drive.damping = check.within(message.damping(), 0, largest, at(field, "damping"));
    drive.mostRate = check.upTo(message.most_speed(), largestComponent, at(field, "mostSpeed"), perSecond);
    const auto limit = [&](double value, const char* name) {
        return check.within(value, -largestComponent, largestComponent, at(field, name), unit);
    };
    if (message.has_least()) drive.least = limit(message.least(), "least");
    if (message.has_most()) drive.most = limit(message.most(), "most");
    if (check.ok() && !(drive.least <= drive.most))
        check.refuse(at(field, "most"),
                     fmt::format("is {}{}, must be at least {}, the value of `least`", drive.most, unit, drive.least));
    if (!check.ok()) return drive;
    drive.place = check.within(message.place(), std::max(drive.least, -largestComponent),
                               std::min(drive.most, largestComponent), at(field, "place"), unit);
    drive.rate = check.within(message.rate(), -drive.mostRate, drive.mostRate, at(field, "rate"), perSecond);
    return drive;
}

void writeDrive(v1::Drive& message, const Drive& drive) {
    setVector(drive.turns ? *message.mutable_about() : *message.mutable_along(), drive.axis);
    message.set_mass(drive.mass);
    if (drive.turns) {
        message.set_inertia(drive.inertia);
        message.set_torque(drive.force);
        setVector(*message.mutable_centre(), drive.centre);
    } else {
        message.set_force(drive.force);
    }
    message.set_damping(drive.damping);
    message.set_most_speed(drive.mostRate);
    if (std::isfinite(drive.least)) message.set_least(drive.least);
    if (std::isfinite(drive.most)) message.set_most(drive.most);
    message.set_place(drive.place);
    message.set_rate(drive.rate);
}

}  // namespace spherule::scene

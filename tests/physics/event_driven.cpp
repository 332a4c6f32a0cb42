#include "event_driven.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

namespace spherule::reference {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

}  // namespace

HardSphereGas::HardSphereGas(std::vector<HardSphere> spheres, double side, double radius, double pairRestitution,
                             double wallRestitution)
    : spheres_(std::move(spheres)),
      movedAt_(spheres_.size()),
      next_(spheres_.size()),
      neighbours_(spheres_.size()),
      margin_(0.5 * side / std::cbrt(spheres_.size())),
      reach_(side / 2 - radius),
      diameter_(2 * radius),
      pairRestitution_(pairRestitution),
      wallRestitution_(wallRestitution) {}

void HardSphereGas::run(double seconds) {
    const double end = time_ + seconds;
    const auto sooner = [](const Event& a, const Event& b) { return a.time < b.time; };
    while (time_ < end) {
        if (time_ >= listedUntil_) listNeighbours();
        const auto first = std::ranges::min_element(next_, sooner);
        const double until = std::min(end, listedUntil_);
        time_ = std::min(first->time, until);
        if (first->time <= until) collide(static_cast<std::size_t>(first - next_.begin()));
    }
}

// Lists the spheres that each sphere may meet until `listedUntil_`.
void HardSphereGas::listNeighbours() {
    double fastest = 0;
    for (const HardSphere& sphere : spheres_) fastest = std::max(fastest, glm::length(sphere.v));
    speedLimit_ = 1.5 * fastest;
    listedUntil_ = time_ + 0.5 * margin_ / speedLimit_;
    std::vector<glm::dvec3> places;
    for (std::size_t k = 0; k < spheres_.size(); ++k) places.push_back(placeOf(k, time_));
    for (std::vector<std::size_t>& list : neighbours_) list.clear();
    for (std::size_t a = 0; a < spheres_.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            const glm::dvec3 d = places[a] - places[b];
            if (glm::dot(d, d) > (diameter_ + margin_) * (diameter_ + margin_)) continue;
            neighbours_[a].push_back(b);
            neighbours_[b].push_back(a);
        }
    }
    for (std::size_t k = 0; k < spheres_.size(); ++k) predict(k);
}

double HardSphereGas::meanSquaredSpeed() const {
    double sum = 0;
    for (const HardSphere& sphere : spheres_) sum += glm::dot(sphere.v, sphere.v);
    return sum / static_cast<double>(spheres_.size());
}

glm::dvec3 HardSphereGas::placeOf(std::size_t k, double time) const {
    return spheres_[k].x + spheres_[k].v * (time - movedAt_[k]);
}

double HardSphereGas::timeOfImpact(std::size_t a, std::size_t b) const {
    const glm::dvec3 c = spheres_[a].v - spheres_[b].v;
    const glm::dvec3 d = placeOf(a, time_) - placeOf(b, time_);
    const double along = glm::dot(c, d);
    if (along >= 0) return never;
    const double gap = glm::dot(d, d) - diameter_ * diameter_;
    const double root = along * along - glm::dot(c, c) * gap;
    if (root < 0) return never;
    return time_ + std::max(gap / (std::sqrt(root) - along), 0.0);
}

void HardSphereGas::predict(std::size_t k) {
    Event& next = next_[k];
    next = {never, k};
    const glm::dvec3 x = placeOf(k, time_);
    const glm::dvec3& v = spheres_[k].v;
    for (int axis = 0; axis < 3; ++axis) {
        if (v[axis] == 0) continue;
        const double time = time_ + std::max((std::copysign(reach_, v[axis]) - x[axis]) / v[axis], 0.0);
        if (time < next.time) next = {time, spheres_.size() + static_cast<std::size_t>(axis)};
    }
    for (const std::size_t other : neighbours_[k])
        if (const double time = timeOfImpact(k, other); time < next.time) next = {time, other};
}

void HardSphereGas::collide(std::size_t k) {
    const std::size_t with = next_[k].with;
    const auto move = [this](std::size_t one) {
        spheres_[one].x = placeOf(one, time_);
        movedAt_[one] = time_;
    };
    move(k);
    HardSphere& sphere = spheres_[k];
    if (with >= spheres_.size()) {
        double& speed = sphere.v[static_cast<int>(with - spheres_.size())];
        wallImpulse_ += (1 + wallRestitution_) * std::abs(speed);
        speed *= -wallRestitution_;
        ++wallImpacts_;
    } else {
        move(with);
        HardSphere& partner = spheres_[with];
        const glm::dvec3 n = glm::normalize(sphere.x - partner.x);
        const double impulse = -0.5 * (1 + pairRestitution_) * glm::dot(sphere.v - partner.v, n);
        sphere.v += n * impulse;
        partner.v -= n * impulse;
        pairImpulse_ += impulse;
        ++pairImpacts_;
        if (glm::length(partner.v) > speedLimit_) listedUntil_ = time_;
    }
    if (glm::length(sphere.v) > speedLimit_) listedUntil_ = time_;
    // The impacts that the others expected with these spheres do not happen. An impact that two spheres expect now is
    // the next event of at least one of them.
    predict(k);
    if (with < spheres_.size()) predict(with);
    for (std::size_t other = 0; other < spheres_.size(); ++other)
        if (other != k && other != with && (next_[other].with == k || next_[other].with == with)) predict(other);
}

}  // namespace spherule::reference

#include "scene/packing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>

#include "scene/check.h"
#include "scene/packing_neighbours.h"

namespace spherule::scene {

namespace {

// Radii are larger by this share while spheres are relaxed: overlaps fall exponentially and would never end, but those
// at the real radii end when they fall below it.
constexpr double clearance = 1e-3;
constexpr double skin = 0.3;      // of the radius: how far spheres move before their neighbours are found again
constexpr double mostWork = 8e9;  // pairs of spheres: about two minutes
constexpr std::uint64_t betweenLooks = 2000;  // steps, after which jammed spheres are recognised
constexpr double jammedFall = 0.9;            // of the energy in these steps

// The constants of the minimiser FIRE, as its authors give them, except the steps: the unit of time is the time in
// which two equal spheres part.
struct Fire {
    static constexpr double firstStep = 0.1;
    static constexpr double longestStep = 0.5;
    static constexpr double firstMixing = 0.1;

    double step = firstStep;
    double mixing = firstMixing;
    int downhill = 0;  // steps without a turn

    void goOn() {
        if (++downhill <= 5) return;
        step = std::min(1.1 * step, longestStep);
        mixing *= 0.99;
    }
    void turn() {
        downhill = 0;
        step = std::max(0.5 * step, 0.02 * firstStep);
        mixing = firstMixing;
    }
};

// Soft spheres. A pair has the energy 1/2 r^2 overlap^2 with the smaller radius r. A sphere has the mass r^2, so that
// small and large ones move in the same time.
class SoftSpheres {
  public:
    SoftSpheres(const std::vector<PackedSphere>& spheres, const PackingSpace& space)
        : space_(space),
          movable_(spheres.size()),
          neighbours_(radiiOf(spheres, space), spheres.size(), 1 + clearance + skin, space) {
        for (const PackedSphere& sphere : spheres) places_.push_back(sphere.centre);
        for (const PackedSphere& sphere : space.fixed) places_.push_back(sphere.centre);
        forces_.resize(places_.size());
        velocities_.resize(movable_);
    }

    // Finds forces, energy and share. Returns false if spheres are crowded.
    bool findForces() {
        if (!isListed() && !list()) return false;
        std::ranges::fill(forces_, glm::dvec3(0));
        energy_ = 0;
        share_ = std::numeric_limits<double>::infinity();
        const std::vector<double>& radii = neighbours_.radii();
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const glm::dvec3 place = places_[i];
            const double radius = radii[i];
            glm::dvec3 force = forces_[i];
            for (const std::uint32_t j : neighbours_.of(i)) {
                const glm::dvec3 d = neighbours_.apart(place, places_[j]);
                const double sum = radius + radii[j];
                const double reach = (1 + clearance) * scale_ * sum;
                const double square = glm::dot(d, d);
                if (square >= reach * reach) continue;
                const double distance = std::sqrt(square);
                const double smaller = std::min(radius, radii[j]);
                const double overlap = reach - distance;
                const glm::dvec3 normal = distance > 0 ? d / distance : glm::dvec3(1, 0, 0);
                const glm::dvec3 push = smaller * smaller * overlap * normal;
                force += push;
                forces_[j] -= push;
                energy_ += smaller * smaller * overlap * overlap;
                share_ = std::min(share_, distance / sum);
            }
            forces_[i] = force;
            work_ += static_cast<double>(neighbours_.of(i).size());
        }
        addSurfaces();
        return true;
    }

    // Moves the spheres by a step of the minimiser.
    void move(Fire& fire) {
        const std::vector<double>& radii = neighbours_.radii();
        double power = 0;
        double speed = 0;
        double strength = 0;
        for (std::size_t i = 0; i < movable_; ++i) {
            const double mass = radii[i] * radii[i];
            power += glm::dot(forces_[i], velocities_[i]);
            strength += glm::dot(forces_[i], forces_[i]) / mass;
        }
        if (power > 0) {
            fire.goOn();
        } else {
            fire.turn();
            std::ranges::fill(velocities_, glm::dvec3(0));
        }
        for (std::size_t i = 0; i < movable_; ++i) {
            velocities_[i] += fire.step / (radii[i] * radii[i]) * forces_[i];
            speed += radii[i] * radii[i] * glm::dot(velocities_[i], velocities_[i]);
        }
        const double along = strength > 0 ? fire.mixing * std::sqrt(speed / strength) : 0;
        for (std::size_t i = 0; i < movable_; ++i) {
            velocities_[i] = (1 - fire.mixing) * velocities_[i] + along / (radii[i] * radii[i]) * forces_[i];
            places_[i] += fire.step * velocities_[i];
        }
    }

    // Makes all radii smaller by this share, fixed ones included.
    void shrink(double share) { scale_ *= 1 - share; }
    [[nodiscard]] double scale() const { return scale_; }
    [[nodiscard]] double energy() const { return energy_; }
    // Returns the least share of the radii at which a pair touches; infinity without overlaps.
    [[nodiscard]] double share() const { return share_; }
    [[nodiscard]] double work() const { return work_ + neighbours_.work(); }
    [[nodiscard]] const std::vector<glm::dvec3>& places() const { return places_; }
    // Returns the energy at which each sphere has an overlap of about this share of its radius.
    [[nodiscard]] double energyOf(double overlap) const {
        double sum = 0;
        for (std::size_t i = 0; i < movable_; ++i) {
            const double square = neighbours_.radii()[i] * neighbours_.radii()[i];
            sum += square * square;
        }
        return overlap * overlap * sum;
    }

  private:
    static std::vector<double> radiiOf(const std::vector<PackedSphere>& spheres, const PackingSpace& space) {
        std::vector<double> radii;
        for (const PackedSphere& sphere : spheres) radii.push_back(sphere.radius);
        for (const PackedSphere& sphere : space.fixed) radii.push_back(sphere.radius);
        return radii;
    }

    // Returns true if no sphere has moved so far that a pair could be missing.
    [[nodiscard]] bool isListed() const {
        if (listed_.empty()) return false;
        for (std::size_t i = 0; i < movable_; ++i) {
            const glm::dvec3 way = places_[i] - listed_[i];
            const double most = skin * neighbours_.radii()[i];
            if (glm::dot(way, way) > most * most) return false;
        }
        return true;
    }

    bool list() {
        for (glm::dvec3& place : places_)
            for (int axis = 0; axis < 3; ++axis)
                if (const double period = space_.periods[axis]; period > 0)
                    place[axis] -= period * std::floor((place[axis] - space_.box.min[axis]) / period);
        listed_.assign(places_.begin(), places_.begin() + static_cast<std::ptrdiff_t>(movable_));
        return neighbours_.find(places_);
    }

    void addSurfaces() {
        constexpr double perDistance = 10;  // pairs
        for (const auto& [i, k] : neighbours_.atSurfaces()) {
            const Surface& surface = space_.surfaces[k];
            const double radius = neighbours_.radii()[i];
            const double distance = surface(places_[i]);
            work_ += perDistance;
            const double overlap = (1 + clearance) * scale_ * radius - distance;
            if (!(overlap > 0)) continue;
            glm::dvec3 normal{};
            const double h = 1e-4 * radius;
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 step(0);
                step[axis] = h;
                normal[axis] = (surface(places_[i] + step) - surface(places_[i] - step)) / (2 * h);
            }
            work_ += 6 * perDistance;
            forces_[i] += radius * radius * overlap * normal;
            energy_ += radius * radius * overlap * overlap;
            share_ = std::min(share_, distance / radius);
        }
    }

    const PackingSpace& space_;
    std::size_t movable_;
    PackingNeighbours neighbours_;
    std::vector<glm::dvec3> places_;  // of movable and fixed spheres
    std::vector<glm::dvec3> forces_;
    std::vector<glm::dvec3> velocities_;
    std::vector<glm::dvec3> listed_;  // where the neighbours were found
    double scale_ = 1;                // of the radii
    double energy_ = 0;
    double share_ = 0;
    double work_ = 0;
};

// Returns the spheres in the order of cells, so that neighbours are near each other in memory.
std::vector<std::uint32_t> byCells(const std::vector<PackedSphere>& spheres, const Box& box) {
    const glm::dvec3 side = box.max - box.min;
    double width = std::max({side.x, side.y, side.z});
    while (8 * width * width * width * static_cast<double>(spheres.size()) > 64 * side.x * side.y * side.z)
        width *= 0.5;
    std::vector<std::uint32_t> order(spheres.size());
    std::iota(order.begin(), order.end(), 0U);
    std::vector<std::uint64_t> cells;
    for (const PackedSphere& sphere : spheres) {
        std::uint64_t cell = 0;
        for (int axis = 2; axis >= 0; --axis)
            cell = (cell << 20U) + static_cast<std::uint64_t>(
                                       std::clamp((sphere.centre[axis] - box.min[axis]) / width, 0.0, 0x1p20 - 1));
        cells.push_back(cell);
    }
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return cells[i]; });
    return order;
}

// Distances must exceed the sum of the radii by more than their rounding.
double roundingOf(const std::vector<PackedSphere>& spheres, const Box& box) {
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::abs(box.min[axis]), std::abs(box.max[axis])});
    const auto smallest = std::ranges::min_element(spheres, {}, &PackedSphere::radius);
    return 16 * std::numeric_limits<double>::epsilon() * (1 + largest / smallest->radius);
}

}  // namespace

PackingEnd pack(Check& check, std::vector<PackedSphere>& spheres, const PackingSpace& space) {
    if (spheres.empty()) return {.packed = true, .share = 1};
    const std::vector<std::uint32_t> order = byCells(spheres, space.box);
    std::vector<PackedSphere> sorted;
    for (const std::uint32_t i : order) sorted.push_back(spheres[i]);
    SoftSpheres soft(sorted, space);
    const double enough = 1 + roundingOf(spheres, space.box);
    const double last = soft.energyOf(0.2 * clearance);
    double first = 0;
    double before = std::numeric_limits<double>::infinity();
    Fire fire;
    PackingEnd end;
    for (std::uint64_t step = 0;; ++step) {
        if (!soft.findForces()) return end;
        const bool free = soft.share() >= enough * soft.scale();
        end = {.packed = free && soft.scale() == 1, .share = std::clamp(soft.share(), 0.0, soft.scale())};
        first = std::max(first, soft.energy());
        const double way = std::log(std::max(soft.energy(), last) / last) / std::log(std::max(first, 2 * last) / last);
        if (!check.goesOn("packing spheres", static_cast<std::size_t>(1000 * (1 - way)), 1000)) return {};
        if (end.packed) break;
        if (free || soft.work() > mostWork) return end;
        if (step % betweenLooks == 0) {
            // Jammed: smaller radii tell how far it would have gone.
            if (soft.energy() > jammedFall * before) soft.shrink(std::sqrt(soft.energy() / soft.energyOf(1)));
            before = soft.energy();
        }
        soft.move(fire);
    }
    for (std::size_t k = 0; k < order.size(); ++k) spheres[order[k]].centre = soft.places()[k];
    return end;
}

double closestPacking(const std::vector<PackedSphere>& spheres) {
    const auto count = static_cast<double>(spheres.size());
    double mean = 0;
    for (const PackedSphere& sphere : spheres) mean += sphere.radius / count;
    double square = 0;
    double cube = 0;
    for (const PackedSphere& sphere : spheres) {
        const double off = sphere.radius / mean - 1;
        square += off * off / count;
        cube += off * off * off / count;
    }
    const double deviation = std::sqrt(square);
    // The skewness times the square of the deviation is cube / deviation.
    return 0.634 + 0.0658 * deviation + (deviation > 0 ? 0.0857 * cube / deviation : 0);
}

std::size_t packingBytesPerSphere() {
    // A growing vector holds its pairs three times for a moment.
    constexpr std::size_t usualPairs = 20;
    return 6 * sizeof(glm::dvec3) + 3 * sizeof(PackedSphere) + 2 * sizeof(double) +
           (3 * usualPairs + 8) * sizeof(std::uint32_t) + sizeof(void*);
}

}  // namespace spherule::scene

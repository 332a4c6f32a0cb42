#include <spdlog/fmt/fmt.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "scene/fill_region.h"
#include "scene/occupancy.h"
#include "scene/packing.h"
#include "scene/periodic_axes.h"
#include "scene/source.h"
#include "scene/surroundings.h"

namespace spherule::scene {

namespace {

// Places are drawn until one is free. Equal spheres placed this way jam at 0.38 of the volume; beyond it they are
// packed. The budget is far above the work for 0.3, and ends a hopeless search.
constexpr std::uint64_t workPerSphere = 2'000;
constexpr std::uint64_t workAtLeast = 10'000'000;
constexpr std::uint64_t workAtMost = 4'000'000'000;  // tens of seconds, for all groups of a scene
constexpr double jammed = 0.38;
constexpr double certainlyJammed = 0.01;    // above closestPacking()
constexpr std::size_t betweenMarks = 1024;  // spheres

double volumeOf(const Sphere& sphere) {
    const auto r = static_cast<double>(sphere.radius);
    return 4 * std::numbers::pi / 3 * r * r * r;
}

double volumeOf(const std::vector<Sphere>& spheres) {
    double sum = 0;
    for (const Sphere& sphere : spheres) sum += volumeOf(sphere);
    return sum;
}

// Returns the spheres by falling radius, because large ones find no place later. Equal radii keep their order.
std::vector<std::uint32_t> byFallingRadius(const std::vector<Sphere>& spheres) {
    std::vector<std::uint32_t> order(spheres.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto smaller = [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; };
    const auto [least, most] = std::ranges::minmax_element(spheres, smaller);
    if (least->radius == most->radius) return order;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return spheres[a].radius > spheres[b].radius; });
    return order;
}

// A fill while it is made.
class Filling {
  public:
    // `amount`: the field that asks for the spheres.
    Filling(Check& check, const FillRegion& region, const Scene& scene, Occupancy& taken, SourceInput& input,
            std::string amount)
        : check_(check), region_(region), scene_(scene), taken_(taken), input_(input), amount_(std::move(amount)) {}

    // Sets the places of the spheres, and adds them to those that are taken. Refuses what does not fit.
    void place(std::vector<Sphere>& spheres) {
        budget_ = std::min(taken_.work() + std::max(workPerSphere * spheres.size(), workAtLeast), workAtMost);
        fraction_ = volumeOf(spheres) / region_.volume;
        if (fraction_ <= jammed && placeAtRandom(spheres)) return;
        if (check_.ok()) packAll(spheres);
    }

  private:
    bool placeAtRandom(std::vector<Sphere>& spheres) {
        std::vector<std::uint32_t> placed;
        for (const std::uint32_t i : byFallingRadius(spheres)) {
            const auto radius = static_cast<double>(spheres[i].radius);
            std::optional<glm::dvec3> place;
            do {
                taken_.addWork(1 + scene_.obstacles.size());
                if (taken_.work() > budget_ || !check_.goesOn("placing spheres", placed.size(), spheres.size())) {
                    drop(spheres, placed);
                    return false;
                }
                place = region_.draw(input_.random, scene_.bounds, radius);
            } while (!place || obstacleAt(scene_, *place, radius) || !taken_.isFree(*place, radius));
            spheres[i].position = *place;
            taken_.add(*place, radius);
            placed.push_back(i);
        }
        return true;
    }

    // Takes back the spheres that have been added, in this order.
    void drop(const std::vector<Sphere>& spheres, const std::vector<std::uint32_t>& placed) {
        for (std::size_t k = placed.size(); k-- > 0;)
            taken_.dropLast(spheres[placed[k]].position, static_cast<double>(spheres[placed[k]].radius));
    }

    void packAll(std::vector<Sphere>& spheres) {
        std::vector<PackedSphere> packed;
        for (const Sphere& sphere : spheres) packed.push_back({.radius = static_cast<double>(sphere.radius)});
        const double reachable = closestPacking(packed);
        if (fraction_ > reachable + certainlyJammed)
            return refuse(spheres.size(), fmt::format("spheres of these radii jam at about {:.3g}", reachable),
                          reachable);
        if (spheres.size() > mostPacked)
            return check_.refuse(
                amount_,
                fmt::format("asks for {} spheres in {:.4g} of the volume of the region, and at most {} can be "
                            "packed; ask for less, or make the region larger",
                            spheres.size(), fraction_, mostPacked),
                Cause::NoRoom);
        const PackingSpace space = spaceFor(packed);
        const auto room =
            memory::Claim::make(amount_, fmt::format("{} spheres to pack", packed.size() + space.fixed.size()),
                                packingBytesPerSphere() * (packed.size() + space.fixed.size()));
        if (!room) return check_.refuse(room.error());
        if (!drawPlaces(packed)) return;
        const PackingEnd end = pack(check_, packed, space);
        if (!check_.ok()) return;
        if (!end.packed || !addAll(spheres, packed)) {
            const double reached = fraction_ * end.share * end.share * end.share;
            refuse(spheres.size(), fmt::format("they jammed at about {:.3g}", reached), reached);
        }
    }

    // `why`: says which fraction can be reached.
    void refuse(std::size_t spheres, const std::string& why, double reachable) {
        check_.refuse(
            amount_,
            fmt::format("asks for {} spheres in {:.4g} of the volume of the region, but {}; ask for less, or "
                        "make the region larger",
                        spheres, fraction_, why),
            Cause::NoRoom,
            {.least = {},
             .most = amount_.ends_with("fraction") ? reachable
                                                   : std::floor(static_cast<double>(spheres) * reachable / fraction_)});
    }

    // Returns the surroundings of the region.
    [[nodiscard]] PackingSpace spaceFor(const std::vector<PackedSphere>& packed) const {
        const Bounds& bounds = scene_.bounds;
        PackingSpace space{.box = region_.box, .surfaces = region_.surfaces(bounds)};
        glm::dvec3 images(0);  // periods of the axes along which the region ends before the seam
        for (int axis = 0; axis < 3; ++axis)
            (spansPeriod(bounds, region_.box, axis) ? space.periods : images)[axis] = bounds.periods()[axis];
        const glm::dvec3 centre = 0.5 * (region_.box.min + region_.box.max);
        const double farthest = 0.5 * glm::distance(region_.box.min, region_.box.max);
        for (const Obstacle& obstacle : scene_.obstacles)
            if (obstacle.distance(centre, scene_.time) < farthest)
                space.surfaces.emplace_back(
                    [&obstacle, time = scene_.time](const glm::dvec3& x) { return obstacle.distance(x, time); });
        const double largest = std::ranges::max_element(packed, {}, &PackedSphere::radius)->radius;
        for (const Sphere& sphere : scene_.spheres)
            for (int image = 0; image < 27; ++image) {
                const glm::dvec3 by(image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1);
                if (glm::dot(glm::abs(by), glm::dvec3(glm::equal(images, glm::dvec3(0)))) > 0) continue;
                const PackedSphere one{sphere.position + by * images, static_cast<double>(sphere.radius)};
                glm::dvec3 nearest = glm::clamp(one.centre, region_.box.min, region_.box.max);
                for (int axis = 0; axis < 3; ++axis)
                    if (space.periods[axis] > 0) nearest[axis] = one.centre[axis];
                if (glm::distance(one.centre, nearest) < 1.1 * (one.radius + largest)) space.fixed.push_back(one);
            }
        return space;
    }

    // Draws places in the region that are clear of obstacles. They may overlap.
    bool drawPlaces(std::vector<PackedSphere>& spheres) {
        const std::uint64_t last = taken_.work() + std::max(workPerSphere * spheres.size(), workAtLeast);
        for (std::size_t k = 0; k < spheres.size(); ++k) {
            std::optional<glm::dvec3> place;
            do {
                taken_.addWork(1 + scene_.obstacles.size());
                if (!check_.goesOn("placing spheres", k, spheres.size())) return false;
                if (taken_.work() > last) {
                    refuse(spheres.size(), "obstacles and the shape of the region leave no places", 0);
                    return false;
                }
                place = region_.draw(input_.random, scene_.bounds, spheres[k].radius);
            } while (!place || obstacleAt(scene_, *place, spheres[k].radius));
            spheres[k].centre = *place;
        }
        return true;
    }

    // Sets the places. Returns false, and adds none, if one is not free.
    bool addAll(std::vector<Sphere>& spheres, const std::vector<PackedSphere>& packed) {
        std::vector<std::uint32_t> placed;
        for (std::uint32_t k = 0; k < spheres.size(); ++k) {
            spheres[k].position = insideBounds(scene_.bounds, packed[k].centre);
            if (!taken_.isFree(spheres[k].position, packed[k].radius)) {
                drop(spheres, placed);
                return false;
            }
            taken_.add(spheres[k].position, packed[k].radius);
            placed.push_back(k);
        }
        return true;
    }

    Check& check_;
    const FillRegion& region_;
    const Scene& scene_;
    Occupancy& taken_;
    SourceInput& input_;
    std::string amount_;
    std::uint64_t budget_ = 0;
    double fraction_ = 0;
};

// Returns how many spheres with these radii have this volume (m^3) or just more; at most `most` + 1.
std::size_t countOf(Check& check, const RadiusDistribution& radii, Random random, double volume, std::size_t most) {
    double sum = 0;
    std::size_t count = 0;
    do {
        if (count % betweenMarks == 0 && !check.goesOn("drawing radii", count, most)) return 0;
        sum += volumeOf(Sphere{.radius = radii.draw(random)});
        ++count;
    } while (sum < volume && count <= most);
    return count;
}

}  // namespace

std::vector<Sphere> fromFill(Check& check, const v1::Fill& fill, const ShapeInput& shapes, const Scene& scene,
                             Occupancy& taken, SourceInput input) {
    const RadiusDistribution& radii = requiredRadii(check, input);
    const FillRegion region = readFillRegion(check, fill, input.field, scene.bounds, shapes);
    const std::string amount = at(input.field, fill.has_fraction() ? "fraction" : "count");
    std::size_t count = fill.count();
    if (fill.has_fraction()) {
        const double fraction = check.upTo(fill.fraction(), 1, amount, "");
        if (check.ok()) count = countOf(check, radii, input.random, fraction * region.volume, input.room);
    } else if (count == 0) {
        check.refuse(amount, "is 0 or missing, must be at least 1; or give a fraction");
    }
    if (!check.ok()) return {};
    const auto room = checkRoom(check, input, static_cast<double>(count), amount,
                                Occupancy::mostBytesPerSphere() + 2 * sizeof(std::uint32_t));  // places and their order
    if (!room) return {};
    if (const double most = region.largestRadius(); most < radii.max) {
        check.refuse(input.field, fmt::format("is {} m wide, too narrow for a radius of {} m", 2 * most, radii.max),
                     Cause::TooLarge, {.least = {}, .most = most});
        return {};
    }

    std::vector<Sphere> spheres;
    spheres.reserve(count);
    while (spheres.size() < count) {
        if (spheres.size() % betweenMarks == 0 && !check.goesOn("drawing radii", spheres.size(), count)) return {};
        spheres.push_back({.velocity = input.velocity, .radius = radii.draw(input.random), .spin = input.spin});
    }
    Filling(check, region, scene, taken, input, amount).place(spheres);
    if (!check.ok()) return {};
    return spheres;
}

}  // namespace spherule::scene

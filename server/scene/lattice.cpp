#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "scene/periodic_axes.h"
#include "scene/source.h"

namespace spherule::scene {

namespace {

// Places per axis. A sphere of the largest radius stays within the region at any jitter.
struct Places {
    glm::dvec3 count{};  // whole numbers, perhaps larger than an integer holds
    glm::dvec3 first{};

    [[nodiscard]] double total() const { return count.x * count.y * count.z; }
};

Places placesIn(const Box& region, const Bounds& bounds, double spacing, double reach) {
    // Keeps a place that only rounding would exclude.
    constexpr double slack = 1e-9;
    Places places;
    for (int axis = 0; axis < 3; ++axis) {
        // The first and the last place are neighbours across a seam.
        const double kept = spansPeriod(bounds, region, axis) ? spacing : 2 * reach;
        const double steps = (region.max[axis] - region.min[axis] - kept) / spacing;
        places.count[axis] = steps < -slack ? 0 : std::floor(steps + slack) + 1;
    }
    const glm::dvec3 centre = 0.5 * (region.min + region.max);
    places.first = centre - 0.5 * spacing * (places.count - 1.0);
    places.first.z = region.min.z + (spansPeriod(bounds, region, 2) ? 0.5 * spacing : reach);
    return places;
}

}  // namespace

std::vector<Sphere> fromLattice(Check& check, const v1::Lattice& lattice, const Bounds& bounds, SourceInput input) {
    const RadiusDistribution& radii = requiredRadii(check, input);
    const Box region = check.box(lattice.min(), lattice.max(), input.field);
    const double spacing = check.positive(lattice.spacing(), at(input.field, "spacing"));
    if (!check.ok()) return {};
    const double jitter = check.within(lattice.jitter(), 0, spacing, at(input.field, "jitter"), " m (the spacing)");
    if (!check.ok()) return {};

    const Places places = placesIn(region, bounds, spacing, radii.max + jitter);
    const double wanted = lattice.has_count() ? lattice.count() : places.total();
    const std::string field = lattice.has_count() ? at(input.field, "count") : input.field;
    // Not "wanted > total": if one axis has no place and another infinitely many, the total is NaN.
    if (!(wanted <= places.total()) || (wanted == 0 && !lattice.has_count())) {
        check.refuse(field,
                     fmt::format("asks for {:.0f} spheres, but {:.0f} x {:.0f} x {:.0f} fit between min and max "
                                 "at a spacing of {} m",
                                 std::max(wanted, 1.0), places.count.x, places.count.y, places.count.z, spacing));
        return {};
    }
    const auto room = checkRoom(check, input, wanted, field);
    if (!room) return {};

    const auto total = static_cast<std::size_t>(wanted);
    std::vector<Sphere> spheres;
    spheres.reserve(total);
    for (double z = 0; spheres.size() < total; ++z) {
        for (double y = 0; y < places.count.y && spheres.size() < total; ++y) {
            if (!check.goesOn("placing spheres", spheres.size(), total)) return {};
            for (double x = 0; x < places.count.x && spheres.size() < total; ++x) {
                Sphere sphere{.position = places.first + spacing * glm::dvec3(x, y, z),
                              .velocity = input.velocity,
                              .spin = input.spin};
                for (int axis = 0; axis < 3; ++axis) sphere.position[axis] += input.random.uniform(-jitter, jitter);
                sphere.position = insideBounds(bounds, sphere.position);
                sphere.radius = radii.draw(input.random);
                spheres.push_back(sphere);
            }
        }
    }
    return spheres;
}

}  // namespace spherule::scene

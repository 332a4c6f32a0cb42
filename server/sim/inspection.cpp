#include "sim/inspection.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "sim/simulation.h"
#include "sim/statistics.h"

namespace spherule::sim {

namespace {

std::vector<TouchedBody> bodiesOf(const std::vector<std::uint32_t>& words, const Simulation& simulation) {
    std::vector<TouchedBody> bodies;
    for (std::size_t k = 1; k + 1 < words.size(); k += 2) {
        TouchedBody touched{.body = {}, .overlap = static_cast<double>(std::bit_cast<float>(words[k + 1]))};
        if ((words[k] & INSPECTED_SURFACE) != 0)
            touched.body = surfaceName(simulation.scene(), words[k] & ~INSPECTED_SURFACE);
        else
            touched.body = simulation.population().idAt(simulation.population().rankOfHandle(words[k]));
        bodies.push_back(std::move(touched));
    }
    // The device finds them in any order.
    std::ranges::sort(bodies, [](const TouchedBody& a, const TouchedBody& b) {
        return a.overlap != b.overlap ? a.overlap > b.overlap : a.body < b.body;
    });
    if (bodies.size() > Inspection::mostContacts) bodies.resize(Inspection::mostContacts);
    return bodies;
}

}  // namespace

Result<std::uint32_t> rankOf(const Population& population, std::uint64_t id, std::string_view field) {
    if (const auto rank = population.rankOf(id)) return *rank;
    return fail(ErrorKind::Refused, std::string(field),
                population.wasBorn(id) ? fmt::format("is {}, a sphere that was removed", id)
                                       : fmt::format("is {}, the scene has {} spheres", id, population.count()),
                Cause::NoSuchSphere);
}

Result<Inspection> inspect(Simulation& simulation, std::uint64_t id, std::string_view field) {
    const auto rank = rankOf(simulation.population(), id, field);
    if (!rank) return tl::unexpected(rank.error());
    const std::uint32_t handle = simulation.population().handleAt(*rank);
    Pipeline& pipeline = simulation.pipeline();
    const auto words = pipeline.inspect(handle);
    if (!words) return tl::unexpected(words.error());
    const scene::Scene& scene = simulation.scene();
    const auto place = pipeline.rowOf<glm::vec4>(handle, Array::Position);
    const auto low = pipeline.rowOf<glm::vec4>(handle, Array::PositionLow);
    const auto velocity = pipeline.rowOf<glm::vec4>(handle, Array::Velocity);
    const auto spin = pipeline.rowOf<glm::vec4>(handle, Array::AngularVelocity);
    const glm::dvec3 position = glm::dvec3(glm::vec3(place)) + glm::dvec3(glm::vec3(low));
    Inspection seen{.sphere = id,
                    .time = simulation.time(),
                    .position = scene.bounds.centre() + scene::separation(position, {}, scene.bounds.periods()),
                    .velocity = glm::vec3(velocity),
                    .spin = glm::vec3(spin),
                    .radius = static_cast<double>(scene.spheres[*rank].radius),
                    .material = scene.materials[scene.spheres[*rank].material].name,
                    .touches = words->front(),
                    .contacts = bodiesOf(*words, simulation)};
    if (!scene.spheres[*rank].fixed) seen.mass = 1 / std::abs(static_cast<double>(velocity.w));
    return seen;
}

}  // namespace spherule::sim

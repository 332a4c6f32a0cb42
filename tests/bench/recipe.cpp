#include "recipe.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "scene/load.h"

namespace spherule::bench {

namespace {

constexpr double height = 4;  // m, of the box

void set(google::protobuf::RepeatedField<double>* field, glm::dvec3 value) {
    for (int axis = 0; axis < 3; ++axis) field->Add(value[axis]);
}

}  // namespace

Result<scene::Scene> box(std::uint32_t spheres, double friction) {
    const double width = 2 * radius * std::sqrt(static_cast<double>(spheres) / layers);
    v1::Scene message;
    message.set_name("box");
    v1::Material& material = *message.add_materials();
    material.set_restitution(0.5);
    material.set_friction(friction);
    message.mutable_quality()->set_substeps(substeps);
    set(message.mutable_bounds()->mutable_min(), {0, 0, 0});
    set(message.mutable_bounds()->mutable_max(), {width, width, height});
    message.mutable_bounds()->add_open(v1::Z_MAX);
    v1::Group& group = *message.add_groups();
    group.mutable_radius()->set_constant(radius);
    v1::Lattice& lattice = *group.mutable_lattice();
    set(lattice.mutable_min(), {0, 0, 0});
    set(lattice.mutable_max(), {width, width, height});
    lattice.set_spacing(2.2 * radius);
    lattice.set_jitter(0.1 * radius);
    lattice.set_count(spheres);
    lattice.set_seed(1);
    return scene::build(message, {.noSleep = true});
}

sim::State arranged(const scene::Scene& scene, const Arrangement& arrangement) {
    sim::State state = sim::stateOf(scene);
    const glm::dvec3 extent = scene.bounds.max - scene.bounds.min;
    const double spacing = arrangement.spacing * radius;
    // In a touching lattice, the jitter may push spheres into the walls; other lattices keep this distance.
    const double room = arrangement.spacing > 2 ? arrangement.jitter * radius : 0;
    const auto across = static_cast<std::uint32_t>(std::floor((extent.x - 2 * (radius + room)) / spacing + 1e-9)) + 1;
    const glm::dvec3 first(-0.5 * spacing * (across - 1), -0.5 * spacing * (across - 1),
                           radius + room - 0.5 * extent.z);
    std::mt19937 random(1);
    auto anywhere = [&random](double reach) {
        std::uniform_real_distribution<double> along(-reach, reach);
        const double x = along(random);
        const double y = along(random);
        return glm::dvec3(x, y, along(random));
    };
    for (std::uint32_t k = 0; k < state.count(); ++k) {
        const glm::dvec3 place(k % across, k / across % across, k / (across * across));
        const glm::dvec3 at = first + spacing * place + anywhere(arrangement.jitter * radius);
        const glm::dvec3 velocity = glm::dvec3(0, 0, -arrangement.fall) + anywhere(arrangement.stir);
        state.position[k] = glm::vec4(glm::vec3(at), radius);
        state.velocity[k] = glm::vec4(glm::vec3(velocity), state.velocity[k].w);
    }
    return state;
}

double meanOverlap(std::vector<glm::vec4> positions) {
    std::ranges::sort(positions, {}, &glm::vec4::x);
    double sum = 0;
    std::uint64_t pairs = 0;
    for (std::size_t a = 0; a < positions.size(); ++a) {
        const float reach = 2 * positions[a].w;
        for (std::size_t b = a + 1; b < positions.size() && positions[b].x - positions[a].x < reach; ++b) {
            const float distance = glm::distance(glm::vec3(positions[a]), glm::vec3(positions[b]));
            if (!(distance < reach)) continue;
            sum += static_cast<double>((reach - distance) / positions[a].w);
            ++pairs;
        }
    }
    return pairs == 0 ? 0 : sum / static_cast<double>(pairs);
}

}  // namespace spherule::bench

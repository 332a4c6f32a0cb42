#include "app/facts.h"

#include <cstring>
#include <string>

#include "scene/goal.h"
#include "scene/quality.h"

namespace spherule::app {

namespace {

template <class Repeated>
void set(Repeated* target, const glm::dvec3& v) {
    for (int axis = 0; axis < 3; ++axis) target->Add(v[axis]);
}

void setObstacles(v1::SceneFacts& facts, const scene::Scene& scene) {
    for (const scene::Obstacle& obstacle : scene.obstacles) {
        v1::Obstacle& message = *facts.add_obstacles();
        message.set_colour(obstacle.colour);
        if (const auto* plane = std::get_if<scene::Plane>(&obstacle.shape)) {
            set(message.mutable_plane()->mutable_point(), plane->point);
            set(message.mutable_plane()->mutable_normal(), plane->normal);
        } else {
            const auto& box = std::get<scene::Box>(obstacle.shape);
            set(message.mutable_box()->mutable_min(), box.min);
            set(message.mutable_box()->mutable_max(), box.max);
        }
    }
}

void setSpheres(v1::SceneFacts& facts, const scene::Scene& scene, bool radiiDiffer) {
    for (const scene::Group& group : scene.groups) {
        v1::GroupFacts& message = *facts.add_groups();
        message.set_name(group.name);
        message.set_first(group.first);
        message.set_count(group.count);
        message.set_colour(group.colour);
    }
    facts.set_count(static_cast<std::uint32_t>(scene.spheres.size()));
    if (!radiiDiffer) {
        facts.set_radius(scene.spheres.empty() ? 0.0F : scene.spheres.front().radius);
        return;
    }
    std::string radii(scene.spheres.size() * sizeof(float), '\0');
    for (std::size_t id = 0; id < scene.spheres.size(); ++id)
        std::memcpy(&radii[id * sizeof(float)], &scene.spheres[id].radius, sizeof(float));
    facts.set_radii(std::move(radii));
}

}  // namespace

v1::ServerMessage factsMessage(const sim::Simulation& simulation, std::uint32_t epoch) {
    const scene::Scene& scene = simulation.scene();
    const sim::Plan& plan = simulation.plan();
    v1::ServerMessage message;
    v1::SceneFacts& facts = *message.mutable_scene();
    facts.set_epoch(epoch);
    facts.set_name(scene.name);
    facts.set_description(scene.description);
    set(facts.mutable_bounds_min(), scene.bounds.min);
    set(facts.mutable_bounds_max(), scene.bounds.max);
    for (int face = 0; face < 6; ++face)
        if (scene.bounds.open[static_cast<std::size_t>(face)]) facts.add_open(static_cast<v1::Face>(face + v1::X_MIN));
    setObstacles(facts, scene);
    setSpheres(facts, scene, plan.features.has(sim::Feature::Radii));
    set(facts.mutable_camera()->mutable_eye(), scene.camera.eye);
    set(facts.mutable_camera()->mutable_target(), scene.camera.target);
    facts.mutable_camera()->set_field_of_view(scene.camera.fieldOfView);
    facts.set_cell_size(static_cast<double>(plan.grid.coarsest().cellSize));
    if (plan.features.has(sim::Feature::Contacts))
        for (int axis = 0; axis < 3; ++axis) facts.add_cells(plan.grid.coarsest().cells[axis]);
    return message;
}

v1::Welcome welcomeOf(const compute::DeviceInfo& device) {
    v1::Welcome welcome;
    welcome.set_server(std::string("spherule ") + SPHERULE_VERSION);
    welcome.set_device(device.kind);
    welcome.set_renderer(device.renderer);
    welcome.set_reason(device.reason);
    return welcome;
}

v1::ServerMessage settingsMessage(const scene::Scene& scene, double speed, bool paused) {
    v1::ServerMessage message;
    v1::Settings& settings = *message.mutable_settings();
    set(settings.mutable_gravity(), scene.gravity);
    settings.set_restitution(scene.materials.front().restitution);
    settings.set_substeps(scene.quality.substeps);
    settings.set_speed(speed);
    settings.set_paused(paused);
    settings.set_step(scene.step);
    settings.set_model(scene::messageOf(scene.quality.model));
    settings.set_friction(scene.materials.front().friction);
    if (scene.quality.goal) *settings.mutable_auto_() = scene::messageOf(*scene.quality.goal);
    return message;
}

}  // namespace spherule::app

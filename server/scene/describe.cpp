#include "scene/describe.h"

#include "scene/check.h"
#include "scene/emitters.h"
#include "scene/quality.h"
#include "scene/quality_goal.h"
#include "scene/surroundings.h"
#include "scene/view.h"

namespace spherule::scene {

namespace {

void setBox(v1::Box& message, const Box& box) {
    setVector(*message.mutable_min(), box.min);
    setVector(*message.mutable_max(), box.max);
}

void setBounds(v1::Scene& message, const Scene& scene, double time) {
    v1::Bounds& to = *message.mutable_bounds();
    setVector(*to.mutable_min(), scene.bounds.min);
    setVector(*to.mutable_max(), scene.bounds.max);
    for (int face = 0; face < 6; ++face)
        if (scene.bounds.open[static_cast<std::size_t>(face)]) to.add_open(static_cast<v1::Face>(face + v1::X_MIN));
    for (int axis = 0; axis < 3; ++axis)
        if (scene.bounds.periodic[static_cast<std::size_t>(axis)]) to.add_periodic(static_cast<v1::Axis>(axis + v1::X));
    to.set_material(scene.materials[scene.bounds.material].name);
    for (const Obstacle& obstacle : scene.obstacles) {
        v1::Obstacle& one = *message.add_obstacles();
        writeObstacle(one, obstacle);
        one.set_material(scene.materials[obstacle.material].name);
        // The scene begins where the motion is now.
        if (!obstacle.motion) continue;
        if (const auto& drive = obstacle.motion->drive)
            one.mutable_motion()->mutable_drive()->set_place(drive->placeAt(time));
        else
            one.mutable_motion()->set_begin(obstacle.motion->begin - time);
    }
    for (const Box& sink : scene.sinks) setBox(*message.add_sinks()->mutable_region(), sink);
}

void setGroups(v1::Scene& message, const Scene& scene) {
    for (const Group& group : scene.groups) {
        v1::Group& to = *message.add_groups();
        to.set_name(group.name);
        to.set_colour(group.look.colour);
        to.set_roughness(group.look.roughness);
        to.set_metal(group.look.metal);
        to.set_material(scene.materials[group.material].name);
        to.set_fixed(group.fixed);
    }
}

}  // namespace

void writeMaterials(const Scene& scene, google::protobuf::RepeatedPtrField<v1::Material>& materials,
                    google::protobuf::RepeatedPtrField<v1::MaterialPair>& pairs) {
    for (const Material& material : scene.materials) {
        v1::Material& to = *materials.Add();
        to.set_name(material.name);
        to.set_density(material.density);
        to.set_restitution(material.restitution);
        to.set_friction(material.friction);
        to.set_rolling_resistance(material.rollingResistance);
        to.set_spinning_resistance(material.spinningResistance);
        if (material.young > 0) to.set_young(material.young);
        to.set_poisson(material.poisson);
    }
    for (const MaterialPair& pair : scene.pairs) {
        v1::MaterialPair& to = *pairs.Add();
        to.set_a(scene.materials[pair.a].name);
        to.set_b(scene.materials[pair.b].name);
        if (pair.restitution) to.set_restitution(*pair.restitution);
        if (pair.friction) to.set_friction(*pair.friction);
        if (pair.rollingResistance) to.set_rolling_resistance(*pair.rollingResistance);
        if (pair.spinningResistance) to.set_spinning_resistance(*pair.spinningResistance);
    }
}

v1::Scene describe(const Scene& scene, double time, std::span<const EmitterProgress> emitters) {
    v1::Scene message;
    message.set_name(scene.name);
    message.set_description(scene.description);
    message.set_what_to_try(scene.whatToTry);
    setVector(*message.mutable_gravity(), scene.forces.gravity);
    writeFields(*message.mutable_fields(), scene.forces.fields);
    writeMaterials(scene, *message.mutable_materials(), *message.mutable_pairs());
    setBounds(message, scene, time);
    setGroups(message, scene);
    writeEmitters(message, scene, time, emitters);
    message.set_step(scene.step);
    v1::Quality& quality = *message.mutable_quality();
    quality.set_model(messageOf(scene.quality.model));
    quality.set_substeps(scene.quality.substeps);
    quality.set_overlap(scene.quality.overlap);
    if (scene.quality.goal) *quality.mutable_auto_() = messageOf(*scene.quality.goal);
    setVector(*message.mutable_camera()->mutable_eye(), scene.camera.eye);
    setVector(*message.mutable_camera()->mutable_target(), scene.camera.target);
    message.mutable_camera()->set_field_of_view(scene.camera.fieldOfView);
    if (scene.light) *message.mutable_light() = messageOf(*scene.light);
    message.mutable_sleep()->set_enabled(scene.sleep.enabled);
    message.mutable_sleep()->set_speed(scene.sleep.speed);
    message.mutable_sleep()->set_time(scene.sleep.time);
    message.set_sphere_contacts(scene.sphereContacts);
    message.set_contact_sums(scene.contactSums);
    return message;
}

}  // namespace spherule::scene

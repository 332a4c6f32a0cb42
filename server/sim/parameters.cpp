#include "sim/parameters.h"

#include <algorithm>
#include <cmath>

#include "scene/materials.h"
#include "scene/stiffness.h"
#include "sim/mesh_tables.h"
#include "sim/modules/module.h"
#include "sim/obstacle_rows.h"

namespace spherule::sim {

namespace {

double springModulusOf(const scene::Scene& scene) {
    return scene.quality.model == scene::Model::Accurate ? scene::springModulus(scene) : 0;
}

layout::ContactParams contactParamsFor(const scene::Scene& scene, std::uint8_t a, std::uint8_t b,
                                       double springModulus) {
    const scene::ContactParameters contact = scene::contactParametersBetween(scene, a, b);
    layout::ContactParams params{.contact = glm::vec4(contact.restitution, contact.friction, contact.rollingResistance,
                                                      contact.spinningResistance),
                                 .stiffness = {}};
    if (scene.quality.model == scene::Model::Accurate) {
        const scene::Stiffness stiffness = scene::stiffnessBetween(scene, a, b, springModulus);
        params.stiffness = glm::vec4(stiffness.normal, stiffness.damping, stiffness.tangential, 0);
    }
    return params;
}

}  // namespace

layout::Parameters parametersFor(const scene::Scene& scene, const Plan& plan, const RadiusStats& radii,
                                 double substep) {
    layout::Parameters p{};
    const glm::dvec3 centre = scene.bounds.centre();
    p.wallMin = glm::vec4(glm::vec3(scene.bounds.min - centre), 0);
    p.wallMax = glm::vec4(glm::vec3(scene.bounds.max - centre), 0);
    p.substep = static_cast<float>(substep);
    p.perSubstep = static_cast<float>(1 / substep);
    p.step = static_cast<float>(scene.step);
    p.spheres = plan.spheres;
    p.radius = static_cast<float>(radii.largest);
    for (unsigned face = 0; face < 6; ++face) {
        if (scene.bounds.walled(face)) p.closedFaces |= 1U << face;
        if (scene.bounds.open[face]) p.openFaces |= 1U << face;
    }
    p.materials = static_cast<std::uint32_t>(scene.materials.size());
    if (!scene.spheres.empty())
        p.material = scene.spheres.front().material;
    else if (!scene.emitters.empty())
        p.material = scene.emitters.front().material;
    p.wallMaterial = scene.bounds.material;
    p.maxWallHistory = plan.maxWallHistory;
    const layout::ContactParams sphereContact = contactParamsFor(
        scene, static_cast<std::uint8_t>(p.material), static_cast<std::uint8_t>(p.material), springModulusOf(scene));
    p.contact = sphereContact.contact;
    p.stiffness = sphereContact.stiffness;
    p.statisticBlocks = blocksOf(plan.spheres, STATISTIC_BLOCK);
    const ParameterSource source{scene, plan, radii, substep};
    for (const Module* module : modules())
        if (module->upload != nullptr && plan.features.has(module->feature)) module->upload(source, p);
    return p;
}

std::vector<layout::ContactParams> contactParamsTable(const scene::Scene& scene) {
    std::vector<layout::ContactParams> table;
    const std::size_t count = scene.materials.size();
    const double modulus = springModulusOf(scene);
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = 0; b < count; ++b)
            table.push_back(
                contactParamsFor(scene, static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), modulus));
    return table;
}

std::vector<scene::Box> sinksOnDevice(const scene::Scene& scene) {
    const glm::dvec3 centre = scene.bounds.centre();
    std::vector<scene::Box> sinks;
    for (const scene::Box& sink : scene.sinks)
        sinks.push_back({glm::dvec3(glm::vec3(sink.min - centre)), glm::dvec3(glm::vec3(sink.max - centre))});
    return sinks;
}

void writeConstants(Pipeline& pipeline, const scene::Scene& scene) {
    if (pipeline.plan().has(Array::Obstacles)) {
        pipeline.write<layout::Obstacle>(Array::Obstacles, ObstacleRows(scene, pipeline.plan().meshes.get()).rows());
        // An empty list, the list of all obstacles, and the meshes.
        std::vector<std::uint32_t> lists{END_OF_LIST};
        for (std::uint32_t k = 0; k < scene.obstacles.size(); ++k) lists.push_back(k);
        lists.push_back(END_OF_LIST);
        if (const auto meshes = pipeline.plan().meshes)
            lists.insert(lists.end(), meshes->words.begin(), meshes->words.end());
        pipeline.write<std::uint32_t>(Array::ObstacleLists, lists);
    }
    if (pipeline.plan().has(Array::ContactParams))
        pipeline.write<layout::ContactParams>(Array::ContactParams, contactParamsTable(scene));
}

}  // namespace spherule::sim

#include "mixtures.h"

#include <cmath>
#include <string>
#include <vector>

#include "mesh_support.h"
#include "mixed.h"
#include "scene/random.h"
#include "scene/shapes.h"
#include "support.h"

namespace spherule::physics {

scene::Scene mixture(scene::Model model) {
    scene::Scene scene = fineStepBox(0.8);
    scene.materials = {{.name = "a", .friction = 0.4, .rollingResistance = 0.1, .spinningResistance = 0.05},
                       {.name = "b", .density = 2500, .restitution = 0.8, .friction = 0.7}};
    scene.bounds.material = 1;
    scene.obstacles.push_back({scene::boxShape({{-0.2, -0.2, -0.4}, {0.1, 0.1, -0.3}}), 0, ""});
    scene.quality = {.model = model, .substeps = model == scene::Model::Accurate ? 100U : 1U};
    scene::Random random(11);
    for (int k = 0; k < 216; ++k) {
        scene::Sphere sphere;
        sphere.radius = static_cast<float>(random.uniform(0.02, 0.045));
        sphere.material = static_cast<std::uint8_t>(k % 2);
        sphere.position = 0.1 * (glm::dvec3(k % 6, k / 6 % 6, k / 36) - 2.5);
        sphere.position.z += 0.1;
        sphere.velocity = {static_cast<float>(random.uniform(-1, 1)), static_cast<float>(random.uniform(-1, 1)), -1};
        sphere.spin = {static_cast<float>(random.uniform(-9, 9)), 3, static_cast<float>(random.uniform(-9, 9))};
        scene.spheres.push_back(sphere);
    }
    return scene;
}

scene::Scene mixedBed(scene::Model model, double ratio) {
    scene::Scene scene = bedUnderOne(ratio < 50 ? 200 : 900, ratio);
    scene.materials[0].friction = 0.4;
    scene.quality = {.model = model, .substeps = model == scene::Model::Accurate ? 100U : 4U};
    for (scene::Sphere& sphere : scene.spheres) sphere.velocity.z = -1;
    return scene;
}

scene::Scene periodicMixture(scene::Model model, double ratio) {
    scene::Scene scene = mixture(model);
    scene.obstacles.clear();
    scene.obstacles.push_back({scene::planeShape({0, 0, -0.55}, {0, 0, 1}), 0, ""});
    scene.bounds.min = {-0.53, -0.49, -0.6};
    scene.bounds.max = {0.53, 0.49, 0.6};
    scene.bounds.periodic = {true, true, false};
    scene.forces.gravity = {3, -2, -9};
    scene.sleep.enabled = true;
    for (std::size_t k = 0; k < scene.spheres.size(); ++k) {
        scene::Sphere& sphere = scene.spheres[k];
        if (k % 3 == 1) sphere.radius /= static_cast<float>(ratio);
        sphere.position += glm::dvec3(0.27, -0.24, -0.2);
        for (int axis = 0; axis < 2; ++axis) {
            const double length = scene.bounds.max[axis] - scene.bounds.min[axis];
            sphere.position[axis] -= length * std::floor(sphere.position[axis] / length + 0.5);
        }
    }
    return scene;
}

scene::Scene mixtureInFields(scene::Model model) {
    scene::Scene scene = mixture(model);
    scene.forces.fields = {scene::Drag{.density = 100}, scene::Attraction{{0.1, 0.2, -0.3}, 0.5, 0.1}};
    for (std::size_t k = 0; k < scene.spheres.size(); k += 5) {
        scene.spheres[k].fixed = true;
        scene.spheres[k].velocity = scene.spheres[k].spin = glm::vec3(0);
    }
    return scene;
}

scene::Scene mixtureInMedia(scene::Model model) {
    scene::Scene scene = mixture(model);
    const glm::dvec3 centre(0.1, -0.1, 0);
    scene.forces.fields = {
        scene::Drag{.density = 80, .velocity = {3, 1, 2}, .region = scene::Box{{-0.3, -0.4, -0.4}, {0.4, 0.2, 0.1}}},
        scene::Drag{.density = 50, .vortex = scene::Vortex{centre, glm::normalize(glm::dvec3(1, 0, 2)), 4, 0.15}},
        scene::Buoyancy{.density = 1500, .surface = glm::dvec3(0, 0, -0.2), .region = scene::BallRegion{centre, 0.4}},
        scene::Buoyancy{.density = 2},
        scene::Spring{.centre = centre,
                      .stiffness = 0.5,
                      .damping = 0.02,
                      .region = scene::CylinderRegion{{0.3, 0.3, -0.3}, {-0.3, -0.2, 0.3}, 0.25}},
        scene::Attraction{.centre = centre, .strength = 0.3, .softening = 0.1}};
    return scene;
}

scene::Scene mixtureAmongMeshes(scene::Model model) {
    scene::Scene scene = mixture(model);
    scene.obstacles.clear();
    scene.obstacles.push_back(
        meshOf(support::boxOf({-0.42, -0.42, -0.38}, {0.42, 0.42, 0.7}), scene::Mesh::Form::Hollow));
    const auto place = [&](const scene::Triangles& triangles, scene::Mesh::Form form, const glm::dvec3& to) {
        scene.obstacles.push_back(
            {.shape = scene::placedShape(scene::meshShape(triangles, form), {{1, 2, 3}, 25}, to), .colour = ""});
    };
    place(support::bumpyBall(0.1, 0.03, 2), scene::Mesh::Form::Solid, {0.2, 0.15, -0.3});
    place(support::boxOf({-0.15, -0.1, -0.01}, {0.15, 0.1, 0.01}), scene::Mesh::Form::Solid, {-0.2, 0.2, -0.25});
    place(support::randomSheet({-0.15, -0.15}, {0.15, 0.15}, 6, 6, 1, 0.05), scene::Mesh::Form::Sheet,
          {-0.1, -0.2, -0.3});
    return scene;
}

scene::Scene mixtureAmongObstacles(scene::Model model) {
    scene::Scene scene = mixture(model);
    scene.obstacles.clear();
    for (const char* const shape :
         {R"("box": {"min": [-0.5, -0.5, -0.4], "max": [0.5, 0.5, 0.6], "hollow": true},
             "rotation": {"axis": [1, 2, 0], "degrees": 4})",
          R"("cone": {"from": [0, 0, 0], "to": [0, 0, 0.2], "fromRadius": 0.15, "toRadius": 0.05},
             "translation": [0.2, 0.1, -0.4])",
          R"("cone": {"from": [-0.25, 0.2, -0.2], "to": [-0.25, 0.2, 0.1], "fromRadius": 0.03, "toRadius": 0.2,
             "open": true})",
          R"("disc": {"centre": [-0.2, -0.25, -0.2], "normal": [1, 0, 3], "radius": 0.2, "hole": 0.05})",
          R"("cylinder": {"from": [0.1, -0.3, -0.3], "to": [0.4, -0.2, -0.2], "radius": 0.1, "open": true})",
          R"("capsule": {"from": [0, -0.1, -0.35], "to": [0.1, 0.2, -0.25], "radius": 0.04})",
          R"("cylinder": {"from": [0, 0.01, -0.35], "to": [0, 0, 0.6], "radius": 0.47, "hollow": true})",
          R"("sphere": {"centre": [0.15, 0.1, -0.3], "radius": 0.1})",
          R"("cylinder": {"from": [-0.3, -0.1, -0.35], "to": [0.2, 0.1, -0.2], "radius": 0.05})"})
        scene.obstacles.push_back(obstacleFrom(std::string("{") + shape + "}"));
    return scene;
}

scene::Scene mixtureAmongMovingObstacles(scene::Model model) {
    scene::Scene scene = mixture(model);
    scene.sleep.enabled = true;
    std::vector<std::string> obstacles = {
        R"("box": {"min": [-0.45, -0.45, -0.5], "max": [0.45, 0.45, 0.7], "hollow": true},
           "motion": {"oscillations": [{"swing": [0.02, 0.05, 0], "amplitude": [0.01, 0, 0], "frequency": 3}]})",
        R"("cylinder": {"from": [-0.3, -0.1, -0.3], "to": [0.2, 0.1, -0.2], "radius": 0.07},
           "motion": {"spin": [9, 3, 2]})",
        R"("box": {"min": [-0.2, -0.02, -0.05], "max": [0.2, 0.02, 0.05]}, "translation": [0.1, 0.1, 0],
           "motion": {"spin": [0, 3, 3], "velocity": [0, 0, -0.1], "begin": 0.05})",
        R"("capsule": {"from": [-0.3, 0.2, -0.3], "to": [0.3, 0.2, -0.3], "radius": 0.05},
           "motion": {"belt": [0.5, 0.2, 0], "oscillations": [{"amplitude": [0, 0, 0.005], "frequency": 20}]})"};
    if (model != scene::Model::Fast) {
        obstacles.push_back(R"("box": {"min": [-0.4, -0.4, 0.36], "max": [0.4, 0.4, 0.4]},
            "motion": {"drive": {"along": [0, 0, 1], "mass": 3, "force": -20, "mostSpeed": 3}})");
        obstacles.push_back(R"("box": {"min": [-0.3, -0.02, -0.3], "max": [0.3, 0.02, -0.1]},
            "motion": {"drive": {"about": [1, 0, 0], "inertia": 0.05, "torque": 2, "mostSpeed": 9}})");
    }
    for (const std::string& obstacle : obstacles) scene.obstacles.push_back(obstacleFrom("{" + obstacle + "}"));
    return scene;
}

scene::Scene layerUnderRain(scene::Model model) {
    scene::Scene scene = sleepyBox(5);
    scene.quality.model = model;
    scene.sleep.time = 0.05;
    measure::setFriction(scene, 0.4);
    scene::Random random(3);
    const auto aside = [&] { return random.uniform(-0.1, 0.1); };
    for (int k = 0; k < 46 * 46; ++k)
        measure::addSphere(scene, {0.105 * (k % 46) - 2.4, 0.105 * (k / 46) - 2.4, -2.45}, 0.05F);
    for (int k = 0; k < 40; ++k)
        measure::addSphere(scene, {0.5 * (k % 8) - 2 + aside(), 0.5 * (k / 8) - 1 + aside(), -1.5 + 0.02 * k}, 0.05F,
                           {0.5, 0.3, -3});
    return scene;
}

}  // namespace spherule::physics

#pragma once

#include <string>

#include "core/archive.h"
#include "scene/mesh/mesh.h"
#include "scene/scene.h"

// The members of a scene, for archives (core/archive.h). Structured bindings name all members of a type: a member that
// is added does not compile until it is listed.
namespace spherule::scene {

// A shape or an emitter's message as bytes, and back. From bytes that are no shape or no message, null.
std::string bytesOf(const Shape& shape);
std::shared_ptr<const Shape> shapeFrom(const std::string& bytes);
std::string bytesOf(const v1::Emitter& message);
std::shared_ptr<const v1::Emitter> emitterFrom(const std::string& bytes);

template <class Archive>
void archive(Archive& a, Box& box) {
    auto& [min, max] = box;
    a(min, max);
}

template <class Archive>
void archive(Archive& a, BallRegion& ball) {
    auto& [centre, radius] = ball;
    a(centre, radius);
}

template <class Archive>
void archive(Archive& a, CylinderRegion& cylinder) {
    auto& [from, to, radius] = cylinder;
    a(from, to, radius);
}

template <class Archive>
void archive(Archive& a, DiscRegion& disc) {
    auto& [centre, normal, radius, hole] = disc;
    a(centre, normal, radius, hole);
}

template <class Archive>
void archive(Archive& a, Vortex& vortex) {
    auto& [centre, axis, speed, core] = vortex;
    a(centre, axis, speed, core);
}

template <class Archive>
void archive(Archive& a, Drag& drag) {
    auto& [density, coefficient, velocity, vortex, region] = drag;
    a(density, coefficient, velocity, vortex, region);
}

template <class Archive>
void archive(Archive& a, Attraction& attraction) {
    auto& [centre, strength, softening, region] = attraction;
    a(centre, strength, softening, region);
}

template <class Archive>
void archive(Archive& a, Buoyancy& buoyancy) {
    auto& [density, surface, region] = buoyancy;
    a(density, surface, region);
}

template <class Archive>
void archive(Archive& a, Spring& spring) {
    auto& [centre, stiffness, damping, region] = spring;
    a(centre, stiffness, damping, region);
}

template <class Archive>
void archive(Archive& a, Forces& forces) {
    auto& [gravity, fields] = forces;
    a(gravity, fields);
}

template <class Archive>
void archive(Archive& a, Material& material) {
    auto& [name, density, restitution, friction, rollingResistance, spinningResistance, young, poisson] = material;
    a(name, density, restitution, friction, rollingResistance, spinningResistance, young, poisson);
}

template <class Archive>
void archive(Archive& a, MaterialPair& pair) {
    auto& [first, second, restitution, friction, rollingResistance, spinningResistance] = pair;
    a(first, second, restitution, friction, rollingResistance, spinningResistance);
}

template <class Archive>
void archive(Archive& a, QualityGoal& goal) {
    auto& [kind, max] = goal;
    a(kind, max);
}

template <class Archive>
void archive(Archive& a, Quality& quality) {
    auto& [model, substeps, substepsFixed, overlap, goal] = quality;
    a(model, substeps, substepsFixed, overlap, goal);
}

template <class Archive>
void archive(Archive& a, Look& look) {
    auto& [colour, roughness, metal] = look;
    a(colour, roughness, metal);
}

template <class Archive>
void archive(Archive& a, Group& group) {
    auto& [name, count, look, material, fixed] = group;
    a(name, count, look, material, fixed);
}

template <class Archive>
void archive(Archive& a, Bounds& bounds) {
    auto& [min, max, open, periodic, material] = bounds;
    a(min, max, open, periodic, material);
}

template <class Archive>
void archive(Archive& a, Rotation& rotation) {
    auto& [axis, degrees] = rotation;
    a(axis, degrees);
}

template <class Archive>
void archive(Archive& a, Oscillation& oscillation) {
    auto& [amplitude, swing, frequency, phase] = oscillation;
    a(amplitude, swing, frequency, phase);
}

template <class Archive>
void archive(Archive& a, Keyframe& keyframe) {
    auto& [time, translation, rotation] = keyframe;
    a(time, translation, rotation);
}

template <class Archive>
void archive(Archive& a, Drive& drive) {
    auto& [axis, turns, mass, inertia, force, centre, damping, mostRate, least, most, place, rate, since] = drive;
    a(axis, turns, mass, inertia, force, centre, damping, mostRate, least, most, place, rate, since);
}

template <class Archive>
void archive(Archive& a, Motion& motion) {
    auto& [velocity, acceleration, spin, pivot, oscillations, keyframes, repeat, belt, begin, duration, drive] = motion;
    a(velocity, acceleration, spin, pivot, oscillations, keyframes, repeat, belt, begin, duration, drive);
}

template <class Archive>
void archive(Archive& a, Obstacle& obstacle) {
    auto& [shape, material, colour, motion] = obstacle;
    std::string bytes = !Archive::loads && shape ? bytesOf(*shape) : std::string();
    a(bytes, material, colour, motion);
    if constexpr (Archive::loads) {
        shape = shapeFrom(bytes);
        if (!shape) a.refuse();
    }
}

template <class Archive>
void archive(Archive& a, Sphere& sphere) {
    auto& [position, velocity, radius, material, fixed, group, spin] = sphere;
    a(position, velocity, radius, material, fixed, group, spin);
}

template <class Archive>
void archive(Archive& /*a*/, RadiusDistribution::Uniform& /*uniform*/) {}

template <class Archive>
void archive(Archive& a, RadiusDistribution::Normal& normal) {
    auto& [mean, deviation] = normal;
    a(mean, deviation);
}

template <class Archive>
void archive(Archive& a, RadiusDistribution::LogNormal& logNormal) {
    auto& [median, deviation] = logNormal;
    a(median, deviation);
}

template <class Archive>
void archive(Archive& a, RadiusDistribution& radii) {
    auto& [min, max, kind] = radii;
    a(min, max, kind);
}

template <class Archive>
void archive(Archive& a, Span& span) {
    auto& [from, to] = span;
    a(from, to);
}

template <class Archive>
void archive(Archive& a, Emitter& emitter) {
    auto& [name, region, rate, massFlow, radii, material, density, velocity, velocitySpread, spin, total, untilChoked,
           origin, begin, schedule, repeat, seed, stream, group, samples, expected, message] = emitter;
    a(name, region, rate, massFlow, radii, material, density, velocity, velocitySpread, spin, total, untilChoked,
      origin, begin, schedule, repeat, seed, stream, group, samples, expected);
    std::string bytes = !Archive::loads && message ? bytesOf(*message) : std::string();
    a(bytes);
    if constexpr (Archive::loads) {
        message = emitterFrom(bytes);
        if (!message) a.refuse();
    }
}

template <class Archive>
void archive(Archive& a, Camera& camera) {
    auto& [eye, target, fieldOfView] = camera;
    a(eye, target, fieldOfView);
}

template <class Archive>
void archive(Archive& a, Light& light) {
    auto& [direction, strength, colour, sky] = light;
    a(direction, strength, colour, sky);
}

template <class Archive>
void archive(Archive& a, Sleep& sleep) {
    auto& [enabled, speed, time] = sleep;
    a(enabled, speed, time);
}

template <class Archive>
void archive(Archive& a, Scene& scene) {
    auto& [name, description, whatToTry, forces, bounds, obstacles, groups, spheres, emitters, materials, pairs, step,
           quality, camera, light, sleep, sinks, sphereContacts, contactSums, time] = scene;
    a(name, description, whatToTry, forces, bounds, obstacles, groups, spheres, emitters, materials, pairs, step,
      quality, camera, light, sleep, sinks, sphereContacts, contactSums, time);
}

template <class Archive>
void archive(Archive& a, Mesh::Edge& edge) {
    auto& [vertices, triangles, flat, meets] = edge;
    a(vertices, triangles, flat, meets);
}

template <class Archive>
void archive(Archive& a, Mesh::Patch& patch) {
    auto& [normal, offset] = patch;
    a(normal, offset);
}

template <class Archive>
void archive(Archive& a, Mesh::Report& report) {
    auto& [triangles, moved, collapsed, duplicated, needles, borders, crowded] = report;
    a(triangles, moved, collapsed, duplicated, needles, borders, crowded);
}

template <class Archive>
void archive(Archive& a, Mesh& mesh) {
    a(mesh.form, mesh.centre, mesh.half, mesh.vertices, mesh.corners, mesh.edgesOf, mesh.edges, mesh.patchOf,
      mesh.patches, mesh.smoothOf, mesh.vertexNormals, mesh.report);
}

// Returns true if all numbers by which the parts of a scene name each other are of parts that exist, and the scene has
// materials. Values are not checked.
bool isWhole(const Scene& scene);

}  // namespace spherule::scene

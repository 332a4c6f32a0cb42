#pragma once

#include "scene/scene.h"

namespace spherule::scene {

// What a scene requires. What is false here is neither compiled, allocated nor dispatched.
struct Features {
    bool gravity = false;
    bool contacts = false;      // sphere against sphere
    bool radii = false;         // radii differ
    bool restitution = false;   // anything bounces (some e > 0)
    bool restitutions = false;  // spheres' e differ
    bool walls = false;         // at least one closed face
    bool planes = false;
    bool boxes = false;
    bool sleep = false;

    // Impacts and sleep ask for the velocity before a substep.
    [[nodiscard]] bool needBefore() const { return contacts || restitution || sleep; }

    bool operator==(const Features&) const = default;
};

Features featuresOf(const Scene& scene);

}  // namespace spherule::scene

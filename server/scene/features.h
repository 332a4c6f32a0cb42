#pragma once

#include "scene/scene.h"

namespace spherule::scene {

// What a scene requires. What is false here is neither compiled, allocated nor dispatched.
struct Features {
    bool gravity = false;
    bool contacts = false;     // sphere against sphere
    bool radii = false;        // radii differ
    bool levels = false;       // so much that each class of sizes has cells of its own: for the plan to say
    bool restitution = false;  // anything bounces (some e > 0)
    bool materials = false;    // spheres are of more than one material
    bool friction = false;     // anything rubs: spheres turn
    bool rolling = false;      // anything resists rolling or spinning
    bool hertz = false;        // Hertz and Mindlin's law in place of linear springs
    bool walls = false;        // at least one closed face
    bool planes = false;
    bool boxes = false;
    bool sleep = false;
    Model model = Model::Balanced;

    [[nodiscard]] bool obstructed() const { return walls || planes || boxes; }
    // Impacts and sleep ask for the velocity before a substep.
    [[nodiscard]] bool needBefore() const { return sleep || (model == Model::Balanced && (contacts || restitution)); }

    // Soft spheres add up forces before any acts.
    [[nodiscard]] bool forces() const { return model == Model::Accurate && (contacts || obstructed()); }

    bool operator==(const Features&) const = default;
};

Features featuresOf(const Scene& scene);

}  // namespace spherule::scene

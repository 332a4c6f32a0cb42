#pragma once

#include "scene/scene.h"

// Scenes that together use all features of a model.
namespace spherule::physics {

// 200 spheres of two materials and many sizes, thrown onto an obstacle in a box, with all contact parameters.
scene::Scene mixture(scene::Model model);

// A bed below a sphere that is `ratio` times as large as the smallest one. Each size class has its own cells.
scene::Scene mixedBed(scene::Model model, double ratio);

// Spheres of several sizes that fall, roll and collide across seams, in bounds that are periodic along x and y.
scene::Scene periodicMixture(scene::Model model, double ratio);

// The mixture in fields, with fixed spheres.
scene::Scene mixtureInFields(scene::Model model);

// The mixture in wind, in a vortex, in a liquid with a surface, and on a spring, in regions of each shape.
scene::Scene mixtureInMedia(scene::Model model);

// In a hollow box of triangles, above a bumpy ball, a blade and a sheet, all of triangles.
scene::Scene mixtureAmongMeshes(scene::Model model);

// In a turned, hollow box, above obstacles of all shapes, many of which have a frame.
scene::Scene mixtureAmongObstacles(scene::Model model);

// In a box that swings, above a roller, a paddle that begins later, and a belt on a plate that shakes. Where the model
// has them, also below a lid that falls, and around a flap.
scene::Scene mixtureAmongMovingObstacles(scene::Model model);

// A layer of 2,116 spheres that falls asleep, while 40 others fall on it from 0.2 s on: these have lists of their own
// (shaders/shared/movers.h).
scene::Scene layerUnderRain(scene::Model model);

}  // namespace spherule::physics

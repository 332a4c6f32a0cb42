// How far a mover may move before its lists are rebuilt. A fast mover would leave its margin in each substep. Its lists
// therefore have the pairs with larger gaps. The includer has included shared/grid.h and shared/movers.h.

// The substeps for which the lists of a mover shall last, at its present speed.
#define MOVER_SUBSTEPS 8.0f

// Returns the largest such distance of all movers (m), a radius of the largest sphere.

float mostMoreMotion() {
    float cell = 1.0f / inverseCellOf(params.moverLevel);
    return max(0.499f * (cell - 2.0f * largestRadius(params.moverLevel) - params.margin), 0.0f);
}

// Returns the distance (m) that a mover may move in addition to params.rebuildMove, and by which its pairs are listed beyond
// the margin. A cell of movers is as wide as two spheres that touch, the margin, and twice the largest such distance.
float moreMotion(float radius, vec4 v) {
    float motion = MOVER_SUBSTEPS * (sqrt(dot3(vec3(v), vec3(v))) + params.gravityChange) * params.substep;
    return finite3(vec3(v)) ? min(motion, min(radius, mostMoreMotion())) : 0.0f;
}

// How far the lists of a mover reach. A fast mover would leave its margin in each substep. It may
// therefore move farther than params.rebuildMove. Its pairs are listed up to a gap that is larger than the margin by the
// same additional distance. The includer has included shared/grid.h, shared/math.h and shared/movers.h.

// The lists of a mover are meant to last for this many substeps at its present speed.
#define MOVER_SUBSTEPS 8.0f

// Returns the largest additional distance of any mover (m). A cell of the movers' level is as wide as two spheres that
// touch, the margin, and twice this distance (addMoverLevel() in server/sim/grid.cpp). The factor allows for rounding.
float mostMoreMotion() {
    float cell = 1.0f / inverseCellOf(params.moverLevel);
    return max(0.499f * (cell - 2.0f * largestRadius(params.moverLevel) - params.margin), 0.0f);
}

// Returns the additional distance (m) of a mover with this radius (m) and row of `velocity`: at most its radius. It is 0 if
// the velocity is not finite.
float moreMotion(float radius, vec4 v) {
    float motion = MOVER_SUBSTEPS * (sqrt(dot3(vec3(v), vec3(v))) + params.gravityChange) * params.substep;
    return finite3(vec3(v)) ? min(motion, min(radius, mostMoreMotion())) : 0.0f;
}

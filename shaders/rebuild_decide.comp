// Sets the sizes of a rebuild's launches, either all of them or none, so that the host never waits for the decision.
// Also counts the substep and moves the frame of the spheres outside.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(coherent, uint, counters)
BUFFER(readonly, uvec4, dispatchSizes)
BUFFER(writeonly, uvec4, dispatchArgs)

#include "shared/falling_frame.h"

void setFrame(vec3 velocity, vec3 path) {
    setFrameVector(COUNTER_FRAME_VELOCITY, velocity);
    setFrameVector(COUNTER_FRAME_PATH, path);
}

KERNEL(1u) {
    if (counters[COUNTER_FRAME_FALLS] != 0u) {
        vec3 path = framePath();
        vec3 velocity = frameVector(COUNTER_FRAME_VELOCITY);
        if (HAS(GRAVITY)) velocity = velocity + vec3(params.gravity) * params.substep;
        setFrame(velocity, path);
    }
    counters[COUNTER_SUBSTEPS] = counters[COUNTER_SUBSTEPS] + 1u;
    bool rebuild = counters[COUNTER_REBUILD] != 0u;
    for (uint row = 0u; row < LAUNCH_ROWS; ++row)
        dispatchArgs[row] = rebuild ? dispatchSizes[row] : uvec4(0u, 1u, 1u, 0u);
    if (rebuild) {
        counters[COUNTER_REBUILD] = 0u;
        counters[COUNTER_PAIRS] = 0u;
        counters[COUNTER_UNLISTED] = 0u;
        counters[COUNTER_SAMPLED] = 0u;
        counters[COUNTER_OUTSIDE] = 0u;
        counters[COUNTER_FRAME_FALLS] = 0u;
        setFrame(vec3(0.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 0.0f));
        counters[COUNTER_REBUILDS] = counters[COUNTER_REBUILDS] + 1u;
    }
}

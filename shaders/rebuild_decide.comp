// Sets the sizes of a rebuild's launches, either all of them or none. `phase` is 0 if the host does not launch them in
// this substep: a rebuild that is due then waits. Also counts the substep, and moves the drift and the frame of the
// spheres outside.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS

BUFFER(coherent, uint, counters)
BUFFER(readonly, uvec4, dispatchSizes)
BUFFER(writeonly, uvec4, dispatchArgs)
BUFFER(writeonly, uint, bundles)

#include "shared/drift.h"
#include "shared/falling_frame.h"

#define FEW_OBSTACLES 8u

// Sets the path of the drift (m).
void setDriftPath(vec3 to) {
    counters[COUNTER_DRIFT_PATH] = floatBitsToUint(to.x);
    counters[COUNTER_DRIFT_PATH + 1u] = floatBitsToUint(to.y);
    counters[COUNTER_DRIFT_PATH + 2u] = floatBitsToUint(to.z);
}

void setFrame(vec3 velocity, vec3 path) {
    setFrameVector(COUNTER_FRAME_VELOCITY, velocity);
    setFrameVector(COUNTER_FRAME_PATH, path);
}

KERNEL(1u) {
    setDriftPath(driftPath());
    if (counters[COUNTER_FRAME_FALLS] != 0u) {
        vec3 path = framePath();
        vec3 velocity = frameVector(COUNTER_FRAME_VELOCITY);
        if (HAS(GRAVITY)) velocity = velocity + vec3(params.gravity) * params.substep;
        setFrame(velocity, path);
    }
    counters[COUNTER_SUBSTEPS] = counters[COUNTER_SUBSTEPS] + 1u;
    uint words = params.bundles * BUNDLE_WORDS;
    bundles[words + WORD_FASTEST] = 0u;
    bool due = (counters[COUNTER_REBUILD] & REBUILD_DUE) != 0u;
    bool soon = false;
    float path = 0.0f;
    if (HAS(MOTION)) {
        path = uintBitsToFloat(counters[COUNTER_OBSTACLE_PATH]) + params.obstaclePath;
        // A sphere without a valid list visits all obstacles, which is no loss while they are few.
        float most = max(params.margin, OBSTACLE_SUBSTEPS * params.obstaclePath);
        due = due || (params.obstacles > FEW_OBSTACLES && path > most);
        soon = params.obstacles > FEW_OBSTACLES && path + SOON_SUBSTEPS * params.obstaclePath > most;
        // An obstacle makes a sphere up to twice as fast.
        soon = soon || 2.0f * SOON_SUBSTEPS * params.obstaclePath > params.rebuildMove;
    }
    bool rebuild = due && phase != 0u;
    if (HAS(MOTION)) counters[COUNTER_OBSTACLE_PATH] = floatBitsToUint(rebuild ? 0.0f : path);
    for (uint row = 0u; row < LAUNCH_ROWS; ++row) {
        bool launched = rebuild && row < LAUNCH_LOST_SPHERES;
        if (row == LAUNCH_UNLISTED) launched = counters[COUNTER_UNLISTED] != 0u;
        dispatchArgs[row] = launched ? dispatchSizes[row] : uvec4(0u, 1u, 1u, 0u);
    }
    uint kept = rebuild ? 0u : counters[COUNTER_REBUILD] & (REBUILD_DUE | LISTS_MISSING);
    // In `fast` and `accurate`, spheres have moved in this substep already.
    if (!HAS(BALANCED) && (counters[COUNTER_REBUILD] & REBUILD_SOON) != 0u) kept = kept | REBUILD_WAS_SOON;
    counters[COUNTER_REBUILD] = kept | (soon ? REBUILD_SOON : 0u);
    if (rebuild) {
        counters[COUNTER_PAIRS] = 0u;
        counters[COUNTER_CANDIDATES] = 0u;
        counters[COUNTER_UNLISTED] = 0u;
        counters[COUNTER_SAMPLED] = 0u;
        counters[COUNTER_OUTSIDE] = 0u;
        counters[COUNTER_CARRIED] = 0u;
        counters[COUNTER_RESTORED] = 0u;
        counters[COUNTER_NEAR_OBSTACLES] = 0u;
        if (counters[COUNTER_RESTING] != 0u) counters[COUNTER_RESTING] = RESTED_BEFORE;
        for (uint k = 0u; k < 6u; ++k) counters[COUNTER_DRIFT_BOX + k] = 0u;
        setDriftPath(vec3(0.0f, 0.0f, 0.0f));  // list_drift.comp sets the drift
        counters[COUNTER_FRAME_FALLS] = 0u;
        setFrame(vec3(0.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 0.0f));
        counters[COUNTER_REBUILDS] = counters[COUNTER_REBUILDS] + 1u;
        uint lists = counters[COUNTER_LISTS] + 1u;
        counters[COUNTER_LISTS] = lists;
        bundles[words + WORD_HALF] = (lists & 1u) * params.pairCapacity;
    }
}

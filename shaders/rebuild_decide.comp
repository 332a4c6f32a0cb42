// Decides whether lists are built, of all spheres or of movers alone (shared/movers.h), and sets the sizes of the
// launches. `phase` is 0 if the host does not launch them in this substep: a rebuild that is due then waits. Also counts the substep, and moves the drift and the frame of the
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
#include "shared/movers.h"

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

uint endOfAllPairs() {
    return counters[COUNTER_MOVER_LISTS] == 0u ? counters[COUNTER_PAIRS] : counters[COUNTER_ALL_PAIRS];
}

// The pairs of the lists of movers have two rooms, which they use in turn.
uint roomOfMoverPairs() {
    return (params.pairCapacity - min(endOfAllPairs(), params.pairCapacity)) / 2u;
}

// The spheres that may be movers now. A sphere that was hit since those that leave were counted is not among them, so
// there is spare room.
uint mostMoversNow() {
    uint more = counters[COUNTER_LEAVING] + min(counters[COUNTER_BORN], params.mostMovers);
    return counters[COUNTER_MOVERS] + more + more / 4u + 16u;
}

// Returns true if it is enough to build lists of the movers and of the spheres that become movers.
bool moversAreEnough() {
    if (!HAS(MOVERS) || (counters[COUNTER_REBUILD] & REBUILD_ALL) != 0u) return false;
    vec3 drift = driftVelocity();
    bool drifts = drift.x != 0.0f || drift.y != 0.0f || drift.z != 0.0f;
    bool holds = counters[COUNTER_REBUILDS] != 0u && counters[COUNTER_UNLISTED] == 0u &&
                 counters[COUNTER_SAMPLED] == 0u && counters[COUNTER_RESTING] != 0u && !drifts;
    uint movers = counters[COUNTER_MOVERS];
    uint awake = counters[COUNTER_AWAKE_MOVERS];
    if (!holds || counters[COUNTER_LEAVING] > params.mostMovers || movers > 2u * awake + FEW_SLEEPING_MOVERS) return false;
    uint most = mostMoversNow();
    bool fits = most <= params.mostMovers && most * PAIRS_OF_MOVER <= roomOfMoverPairs() &&
                counters[COUNTER_MOVER_LISTS] < MOST_MOVER_LISTS;
    if (HAS(OBSTACLES)) fits = fits && counters[COUNTER_NEAR_OBSTACLES] + 4u * most < params.obstacleListWords / 2u;
    return fits;
}

// The launch over the spheres whose lists are built.
uvec4 launchOver(uint spheres) {
    return uvec4((spheres + LAUNCH_THREADS - 1u) / LAUNCH_THREADS, 1u, 1u, spheres);
}

// Begins lists of the movers alone.
void beginMoverLists() {
    uint all = endOfAllPairs();
    uint room = roomOfMoverPairs();
    uint lists = counters[COUNTER_MOVER_LISTS] + 1u;
    counters[COUNTER_MOVER_ROOM] = mostMoversNow();
    counters[COUNTER_ALL_PAIRS] = all;
    counters[COUNTER_MOVER_LISTS] = lists;
    counters[COUNTER_MOVER_PAIRS] = all + (lists & 1u) * room;
    counters[COUNTER_PAIRS] = counters[COUNTER_MOVER_PAIRS];
    counters[COUNTER_PAIR_LIMIT] = counters[COUNTER_MOVER_PAIRS] + room;
}

// Begins lists of all spheres.
void beginLists() {
    counters[COUNTER_PAIRS] = 0u;
    counters[COUNTER_PAIR_LIMIT] = params.pairCapacity;
    counters[COUNTER_MOVERS] = 0u;
    counters[COUNTER_MOVER_LISTS] = 0u;
    counters[COUNTER_SORTED] = params.spheres;
    counters[COUNTER_SAMPLED] = 0u;
    counters[COUNTER_OUTSIDE] = 0u;
    counters[COUNTER_NEAR_OBSTACLES] = 0u;
    if (counters[COUNTER_RESTING] != 0u) counters[COUNTER_RESTING] = RESTED_BEFORE;
    for (uint k = 0u; k < 6u; ++k) counters[COUNTER_DRIFT_BOX + k] = 0u;
    setDriftPath(vec3(0.0f, 0.0f, 0.0f));  // list_drift.comp sets the drift
    counters[COUNTER_FRAME_FALLS] = 0u;
    setFrame(vec3(0.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 0.0f));
    uint lists = counters[COUNTER_LISTS] + 1u;
    counters[COUNTER_LISTS] = lists;
    bundles[params.bundles * BUNDLE_WORDS + WORD_HALF] = (lists & 1u) * params.pairCapacity;
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
    bundles[params.bundles * BUNDLE_WORDS + WORD_FASTEST] = 0u;
    bundles[params.bundles * BUNDLE_WORDS + WORD_FASTEST_MOVER] = 0u;
    bool due = (counters[COUNTER_REBUILD] & REBUILD_DUE) != 0u || counters[COUNTER_BORN] != 0u;
    bool soon = false;
    bool all = !moversAreEnough();
    float path = 0.0f;
    if (HAS(MOTION)) {
        path = uintBitsToFloat(counters[COUNTER_OBSTACLE_PATH]) + params.obstaclePath;
        // A sphere without a valid list visits all obstacles, which is no loss while they are few.
        float most = max(params.margin, OBSTACLE_SUBSTEPS * params.obstaclePath);
        bool moved = params.obstacles > FEW_OBSTACLES && path > most;
        due = due || moved;
        all = all || moved;
        soon = params.obstacles > FEW_OBSTACLES && path + SOON_SUBSTEPS * params.obstaclePath > most;
        // An obstacle makes a sphere up to twice as fast.
        soon = soon || 2.0f * SOON_SUBSTEPS * params.obstaclePath > params.rebuildMove;
    }
    bool rebuild = due && phase != 0u;
    all = rebuild && all;
    bool alone = rebuild && !all;
    if (HAS(MOTION)) counters[COUNTER_OBSTACLE_PATH] = floatBitsToUint(all ? 0.0f : path);
    for (uint row = 0u; row < LAUNCH_ROWS; ++row) {
        bool launched = rebuild && row < LAUNCH_LOST_SPHERES;
        if (row == LAUNCH_UNLISTED) launched = counters[COUNTER_UNLISTED] != 0u;
        if (row == LAUNCH_MOVERS) launched = alone || (!all && counters[COUNTER_MOVERS] != 0u);
        dispatchArgs[row] = launched ? dispatchSizes[alone ? LAUNCH_ROWS + row : row] : uvec4(0u, 1u, 1u, 0u);
    }
    if (alone) dispatchArgs[LAUNCH_SPHERES] = launchOver(mostMoversNow());
    uint word = counters[COUNTER_REBUILD];
    uint kept = rebuild ? 0u : word & (REBUILD_DUE | REBUILD_ALL | LISTS_MISSING);
    if (alone || (!all && (word & MOVERS_EXIST) != 0u)) kept = kept | MOVERS_EXIST;
    // In `fast` and `accurate`, spheres have moved in this substep already.
    if (!HAS(BALANCED) && (word & REBUILD_SOON) != 0u) kept = kept | REBUILD_WAS_SOON;
    counters[COUNTER_REBUILD] = kept | (soon ? REBUILD_SOON : 0u);
    if (rebuild) {
        counters[COUNTER_MOVERS_ALONE] = alone ? LISTS_BEGUN : 0u;
        if (alone)
            beginMoverLists();
        else
            beginLists();
        counters[COUNTER_BORN] = 0u;
        counters[COUNTER_CANDIDATES] = 0u;
        counters[COUNTER_UNLISTED] = 0u;
        counters[COUNTER_CARRIED] = 0u;
        counters[COUNTER_RESTORED] = 0u;
        counters[COUNTER_REBUILDS] = counters[COUNTER_REBUILDS] + 1u;
    }
    counters[COUNTER_LEAVING] = 0u;  // mark_active.comp counts them
    counters[COUNTER_AWAKE_MOVERS] = 0u;
}

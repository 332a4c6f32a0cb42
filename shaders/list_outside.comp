// Sets the room of each sphere outside the bounds among the others there, and whether a list pairs it with one of them.
// Starts the frame of the spheres outside with the velocity of the fastest one, or at rest if one of them is asleep.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/limits.h"
#include "shared/outside.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, cellOrder)
BUFFER(coherent, uint, counters)
BUFFER(restrict, vec4, listReference)

#include "shared/falling_frame.h"

// Returns true if a is faster than b. The sphere with the lower id counts as faster if the speeds are equal, because
// the spheres come in any order.
bool faster(uint a, uint b) {
    vec3 va = vec3(velocity[a]);
    vec3 vb = vec3(velocity[b]);
    float sa = dot3(va, va);
    float sb = dot3(vb, vb);
    return sa > sb || (sa == sb && idOf(idAndMaterial[a]) < idOf(idAndMaterial[b]));
}

KERNEL(MOST_OUTSIDE) {
    uint count = counters[COUNTER_OUTSIDE];
    if (count > MOST_OUTSIDE || invocation >= count) return;
    uint mine = cellOrder[invocation];
    vec4 p = position[mine];
    float room = UNLIMITED_ROOM;
    bool listed = false;
    bool rests = false;
    uint fastest = mine;
    for (uint k = 0u; k < count; ++k) {
        uint other = cellOrder[k];
        if (HAS(SLEEP)) rests = rests || isAsleep(velocity[other]);
        if (other == mine) continue;
        if (faster(other, fastest)) fastest = other;
        vec4 q = position[other];
        vec3 d = separation(vec3(p), vec3(q));
        float touch = radiusSum(p, q);
        float reach = touch + params.margin;
        float squared = dot3(d, d);
        if (squared < reach * reach) {
            listed = true;
        } else {
            room = min(room, sqrt(squared) - touch);
        }
    }
    listReference[mine] = vec4(vec3(p), listed ? -room : room);
    if (fastest != mine || rests) return;
    counters[COUNTER_FRAME_FALLS] = 1u;
    setFrameVector(COUNTER_FRAME_VELOCITY, vec3(velocity[mine]));
}

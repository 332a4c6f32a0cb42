// The models `fast` and `accurate`: moves each awake sphere along its ballistic arc: v += a h, x += v h - a h^2 / 2.
// The arc is exact under gravity alone, where a = g. Never derives a velocity from positions, because float32 positions
// are too coarse for it.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/wrap.h"
#include "shared/fields.h"
#include "shared/shapes.h"
#include "shared/limits.h"
#include "shared/outside.h"

BUFFER(restrict, vec4, position)
BUFFER(restrict, vec4, positionLow)
BUFFER(restrict, vec4, velocity)
BUFFER(writeonly, vec4, velocityBefore)
BUFFER(readonly, vec4, listReference)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(coherent, uint, counters)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, obstacleLists)

#include "shared/drift.h"
#include "shared/falling_frame.h"
#include "shared/moving.h"
#include "shared/mesh_room.h"
#include "shared/ask_for_lists.h"
#include "shared/motion.h"

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    if ((HAS(SLEEP) || HAS(FIXED)) && !isAwake(v)) return;
    vec4 x = position[invocation];
    if (farthestOf(vec3(x)) > LAST_PLACE && finite3(vec3(x))) return;
    float h = params.substep;
    if (HAS(SLEEP)) velocityBefore[invocation] = v;
    vec3 arcVelocity = vec3(v);
    if (HAS(GRAVITY) || HAS(FIELDS)) {
        vec3 mean = HAS(GRAVITY) ? vec3(params.gravity) : vec3(0.0f, 0.0f, 0.0f);
        if (HAS(FIELDS)) mean = meanAcceleration(mean, vec3(x), vec3(v), radiusOf(x), inverseMassOf(v));
        vec3 deltaVelocity = mean * h;
        arcVelocity = arcVelocity + deltaVelocity;
        velocity[invocation] = withXyz(v, arcVelocity);
        arcVelocity = arcVelocity - deltaVelocity * 0.5f;
    }
    precise vec3 to = vec3(x) + arcVelocity * h;
    if (HAS(LOW_BITS)) {
        // Adds the residual of the position beyond float32. Without it, short substeps would not move a slow sphere at
        // all.
        vec4 residual = positionLow[invocation];
        precise vec3 low = vec3(residual) + arcVelocity * h;
        to = vec3(x) + low;
        precise vec3 held = to - vec3(x);
        positionLow[invocation] = withXyz(residual, low - held);
    }
    position[invocation] = withXyz(x, to);
    if (!finite3(to)) {
        // The sphere is counted and reported. It touches nothing, because comparisons with its position are false.
        atomicAdd(counters[COUNTER_NON_FINITE], 1u);
        atomicMax(counters[COUNTER_FIRST_ID], ~idOf(idAndMaterial[invocation]));
        return;
    }
    checkMotion(invocation, x, arcVelocity, to);
}

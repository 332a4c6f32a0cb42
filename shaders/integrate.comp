// Moves every awake sphere along its ballistic arc, exactly: v += g h, x += v h - g h^2 / 2. Never derives a velocity
// from positions, which float32 would not bear. Asks for new pair lists when a sphere has left its margin.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/label.h"

BUFFER(0, restrict, vec4, position, PositionBlock)
BUFFER(1, restrict, vec4, velocity, VelocityBlock)
BUFFER(2, restrict, vec4, before, BeforeBlock)
BUFFER(3, readonly, vec4, anchor, AnchorBlock)
BUFFER(4, readonly, uint, label, LabelBlock)
BUFFER(5, coherent, uint, counters, CounterBlock)
BUFFER(6, restrict, vec4, resting, RestingBlock)

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    if (HAS(SLEEP) && v.w < 0.0f) return;
    vec4 x = position[invocation];
    float h = params.substep;
    if (HAS(BEFORE)) before[invocation] = vec4(vec3(v), before[invocation].w);
    vec3 moved = vec3(v);
    if (HAS(GRAVITY)) {
        vec3 kick = vec3(params.gravity) * h;
        moved = moved + kick;
        velocity[invocation] = vec4(moved, v.w);
        moved = moved - kick * 0.5f;
    }
    precise vec3 to = vec3(x) + moved * h;
    if (HAS(RESIDUAL)) {
        // What float32 cannot hold of the position: short substeps would not move a slow sphere at all.
        vec4 residual = position[params.spheres + invocation];
        precise vec3 low = vec3(residual) + moved * h;
        to = vec3(x) + low;
        precise vec3 held = to - vec3(x);
        position[params.spheres + invocation] = vec4(low - held, residual.w);
    }
    position[invocation] = vec4(to, x.w);
    if (!finite3(to)) {
        // Counted and reported; such a sphere touches nothing, because comparisons with it fail.
        atomicAdd(counters[COUNTER_NON_FINITE], 1u);
        atomicMax(counters[COUNTER_FIRST_ID], ~idOf(label[invocation]));
        return;
    }
    float far = FAR_MOTION * (HAS(RADII) ? x.w : params.radius);
    float squared = dot3(moved, moved) * h * h;
    if (squared > far * far)
        atomicMax(counters[COUNTER_FASTEST], floatBitsToUint(sqrt(squared) * FAR_MOTION / far));
    if (HAS(CONTACTS)) {
        vec3 since = to - vec3(anchor[invocation]);
        if (dot3(since, since) > params.rebuildMove * params.rebuildMove) atomicOr(counters[COUNTER_REBUILD], 1u);
        // Not from `anchor`, which starts anew whenever some other sphere needs new lists: a slow one would never have
        // moved at all.
        if (HAS(SLEEP)) {
            uint id = idOf(label[invocation]);
            vec3 crept = to - vec3(resting[id]);
            if (dot3(crept, crept) > params.creep * params.creep) {
                resting[id] = vec4(to, 0.0f);
                before[invocation] = vec4(vec3(v), CREPT);
            }
        }
    }
}

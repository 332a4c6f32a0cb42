// Puts a sphere to sleep if it has been quiet for the sleep time, and if it is carried now.
//
// With friction, spheres of `balanced` fall asleep together: once in SLEEP_INTERVAL substeps, in blocks that are calm.
// A block is calm if neither it nor a block around it holds a restless sphere (mark_active.comp). The sleepers of other
// blocks wake. Sleepers beside spheres that still settle would get unbalanced loads, and jump when they wake.
//
// A sphere also keeps a rest reference, and wakes the sleepers around it when it has moved away from it. That is not
// the list reference, which is reset whenever any sphere needs new lists: a slow sphere would then never have moved
// away.
//
// A slow sphere may also be at the top of its flight. A sphere therefore counts as carried only if contacts took up at
// least half of the pull of gravity and attractions in this substep.
//
// A spin about the normal of a sphere's only contact with friction takes long to end. The longer a sphere has stayed,
// the faster it may therefore turn. A sphere asks for new lists if it falls asleep outside the bounds or while the
// lists drift, because it would not notice that their frame moves away from it.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/fields.h"
#include "shared/grid.h"
#include "shared/bundles.h"
#include "shared/cell_of.h"
#include "shared/limits.h"
#include "shared/outside.h"

BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(restrict, vec4, velocityBefore)
BUFFER(restrict, vec4, unheldVelocity)
BUFFER(restrict, vec4, unheldSpin)
BUFFER(restrict, vec4, restReference)  // by id; w: see accessors.h
BUFFER(readonly, vec4, position)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, vec4, listReference)  // position for which the lists were built: it gives the sphere's block
BUFFER(readonly, uint, restlessBlock)
BUFFER(coherent, uint, counters)

#include "shared/drift.h"

// Returns true if no sphere around the block was restless at the beginning of the substep.
bool isCalm(uint sphere, uint substep) {
    vec3 place = vec3(listReference[sphere]);
    uint level = levelOf(storedRadius(position[sphere]));
    vec3 cells = inverseCellsOf(level);
    vec3 width = vec3(4.0f / cells.x, 4.0f / cells.y, 4.0f / cells.z);
    for (uint k = 0u; k < 27u; ++k) {
        vec3 step = vec3(float(k % 3u) - 1.0f, float(k / 3u % 3u) - 1.0f, float(k / 9u) - 1.0f);
        if (restlessBlock[blockAt(place + step * width, level)] == substep) return false;
    }
    return true;
}

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    bool together = HAS(BALANCED) && HAS(FRICTION);
    uint substep = counters[COUNTER_SUBSTEPS];
    bool inTime = !together || substep % SLEEP_INTERVAL == 0u;
    uint id = idOf(idAndMaterial[invocation]);
    if (isAsleep(v)) {
        if (together && inTime && !isCalm(invocation, substep)) {
            velocity[invocation] = sleepToggled(v);
            restReference[id].w = params.sleepTime;  // it is not restless
        }
        return;
    }
    if (HAS(FIXED) && isFixed(v)) return;
    vec3 p = vec3(position[invocation]);
    vec4 u = velocityBefore[invocation];
    vec4 rest = restReference[id];
    float squared = dot3(vec3(v), vec3(v));
    bool quiet = squared < params.quietSpeed * params.quietSpeed;
    float quietTime = quiet ? quietTimeOf(rest) + params.substep : 0.0f;
    vec3 sinceRest = separation(p, vec3(rest));
    if (dot3(sinceRest, sinceRest) > params.moveAwayDistance * params.moveAwayDistance) {
        restReference[id] = movedAway(p, together ? quietTime : 0.0f);
        return;
    }
    bool fallsAsleep = inTime && quietTime >= params.sleepTime && squared < params.sleepSpeed * params.sleepSpeed;
    if (HAS(GRAVITY)) {
        vec3 pull = vec3(params.gravity);
        vec3 change = pull;
        if (HAS(FIELDS)) {
            // The threshold has no drag. Drag takes all of gravity from a sphere at its terminal speed, and leaves two
            // differences of rounding to compare.
            float radius = radiusOf(position[invocation]);
            pull = accelerationOnPath(pull, p, vec3(u), radius, inverseMassOf(v));
            change = withDrag(pull, p, vec3(u), radius, inverseMassOf(v));
        }
        vec3 contactChange = vec3(v) - vec3(u) - change * params.substep;
        float least = 0.5f * params.substep;
        float weight = dot3(pull, pull);
        // Fields may balance gravity, so that nothing carries the sphere.
        if (HAS(FIELDS)) weight = max(weight, 0.01f * dot3(vec3(params.gravity), vec3(params.gravity)));
        fallsAsleep = fallsAsleep && dot3(contactChange, contactChange) > least * least * weight;
    }
    if (HAS(FRICTION)) {
        vec3 spin = vec3(angularVelocity[invocation]) * radiusOf(position[invocation]);
        float maxSpin = params.sleepSpeed * min(quietTime / params.sleepTime, 4.0f);
        fallsAsleep = fallsAsleep && dot3(spin, spin) < maxSpin * maxSpin;
    }
    if (fallsAsleep && together) fallsAsleep = isCalm(invocation, substep);
    restReference[id] = vec4(vec3(rest), fallsAsleep ? 0.0f : quietTime);
    if (!fallsAsleep) return;
    atomicOr(counters[COUNTER_RESTING], RESTS);
    vec3 drift = driftVelocity();
    if (beyond(p) > 0.0f || dot3(drift, drift) > 0.0f) atomicOr(counters[COUNTER_REBUILD], REBUILD_DUE | REBUILD_ALL);
    // The velocity before the substep is zero too: neighbours bounce off a sphere at rest.
    velocityBefore[invocation] = vec4(0.0f, 0.0f, 0.0f, u.w);
    velocity[invocation] = sleepToggled(withXyz(v, vec3(0.0f, 0.0f, 0.0f)));
    // The sphere keeps the impulses that it holds, without its velocity and its spin. If it holds none, its rows become
    // zero, to which contacts add while it sleeps.
    bool holds = false;
    if (HAS(BALANCED)) {
        vec4 unheld = unheldVelocity[invocation];
        holds = unheld.w != 0.0f;
        unheldVelocity[invocation] = withXyz(unheld, holds ? vec3(unheld) - vec3(v) : vec3(0.0f, 0.0f, 0.0f));
    }
    if (!HAS(FRICTION)) return;
    vec3 spin = vec3(angularVelocity[invocation]);
    angularVelocity[invocation] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    if (!HAS(BALANCED)) return;
    vec4 unheldTurn = unheldSpin[invocation];
    unheldSpin[invocation] = withXyz(unheldTurn, holds ? vec3(unheldTurn) - spin : vec3(0.0f, 0.0f, 0.0f));
}

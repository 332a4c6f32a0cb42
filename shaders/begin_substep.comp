// Begins a substep of the model `balanced`: adds gravity, fields and the impulses that contacts hold to each velocity.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/fields.h"

BUFFER(readonly, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(writeonly, vec4, velocityBefore)
BUFFER(restrict, vec4, unheldVelocity)
BUFFER(restrict, vec4, unheldSpin)
BUFFER(restrict, uint, accelerationXz)
BUFFER(restrict, uint, accelerationYz)
BUFFER(coherent, uint, bundles)
BUFFER(readonly, uint, counters)
BUFFER(readonly, uint, isMover)

#include "shared/drift.h"

// A sphere's own acceleration is a running mean over this many substeps. The value of a single substep makes an elastic
// gas under gravity lose energy.
#define MEAN_OVER 8.0f
#define LARGEST_SQUARE 1.0e38f

LANE_KERNEL(params.spheres) {
    real4 v = ROW(velocity, invocation);
    mask awake = liveLanes() && isAwake(v);
    if (!anyLane(awake)) return;
    real4 unheld = ROW(unheldVelocity, invocation);
    mask holds = unheld.w != 0.0f;
    real3 nothing = real3(0.0f, 0.0f, 0.0f);
    precise real3 held = select(holds, real3(v) - real3(unheld), nothing);
    real3 fall = real3(0.0f, 0.0f, 0.0f);
    if (HAS(GRAVITY)) fall = real3(params.gravity) * params.substep;
    real3 pull = fall;  // without drag, which takes no part in the threshold of impacts
    if (HAS(FIELDS)) {
        real4 x = ROW(position, invocation);
        real3 gravity = HAS(GRAVITY) ? real3(params.gravity) : real3(0.0f, 0.0f, 0.0f);
        real3 a = accelerationOnPath(gravity, real3(x), real3(v), radiusOf(x), inverseMassOf(v));
        pull = a * params.substep;
        fall = withDrag(a, real3(x), real3(v), radiusOf(x), inverseMassOf(v)) * params.substep;
    }
    uints xz = ROW(accelerationXz, invocation);
    uints yz = ROW(accelerationYz, invocation);
    real3 mean = ownAcceleration(xz, yz);
    real3 now = mean + (held + pull - mean) * (1.0f / MEAN_OVER);
    SET_ROW(awake, accelerationXz, invocation, accelerationXzOf(now), xz)
    SET_ROW(awake, accelerationYz, invocation, accelerationYzOf(now), yz)
    real squared = max(dot3(now, now), real(params.gravityChange * params.gravityChange));
    if (HAS(FIELDS)) squared = max(squared, dot3(pull, pull));
    SET_ROW(awake, velocityBefore, invocation, real4(real3(v), squared), v)
    precise real3 unheldNow = real3(v) + fall;
    precise real3 start = unheldNow + held;
    SET_ROW(awake, unheldVelocity, invocation, real4(unheldNow, unheld.w), unheld)
    SET_ROW(awake, velocity, invocation, real4(start, v.w), v)
    if (HAS(CONTACTS)) {
        real3 relative = start - real3(driftVelocity());
        real square = dot3(relative, relative);
        mask counted = awake && square < LARGEST_SQUARE;
        mask mover = noLane();
        if (HAS(MOVERS)) mover = ROW(isMover, invocation) != uints(0u);
        RAISE_TO(counted && !mover, bundles[params.bundles * BUNDLE_WORDS + WORD_FASTEST], square)
        if (anyLane(mover)) RAISE_TO(counted && mover, bundles[params.bundles * BUNDLE_WORDS + WORD_FASTEST_MOVER], square)
    }
    if (HAS(FRICTION)) {
        real4 s = ROW(angularVelocity, invocation);
        real4 unheldTurn = ROW(unheldSpin, invocation);
        precise real3 turn = select(holds, real3(s) - real3(unheldTurn), nothing);
        SET_ROW(awake, unheldSpin, invocation, real4(real3(s), unheldTurn.w), unheldTurn)
        SET_ROW(awake, angularVelocity, invocation, real4(real3(s) + turn, s.w), s)
    }
}

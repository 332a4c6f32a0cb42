// The model `accurate`: adds up the forces between overlapping soft spheres on both sides, while velocities stay
// unchanged. (If velocities changed at once, each pair would see the incomplete sum of the other forces, take it for
// slip, and load its spring.) The displacement of the tangential spring is stored with the listed pair. `phase` is the
// level and the colour of the groups.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/math.h"
#include "shared/grid.h"
#include "shared/id_and_material.h"
#include "shared/contact.h"
#include "shared/friction.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, positionLow)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, angularVelocity)
BUFFER(restrict, vec4, deltaVelocity)
BUFFER(restrict, vec4, deltaOmega)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, uint, cellStart)
BUFFER(restrict, uvec4, groupRange)
BUFFER(readonly, uvec2, pairs)
BUFFER(restrict, vec4, tangentialSlip)  // per listed pair: displacement of the first (m); w: 1 in touch
BUFFER(readonly, ContactParams, contactParams)

PRIVATE(vec3, displacement)
PRIVATE(bool, touches)
PRIVATE(bool, listed)     // the pair keeps its displacement; an unlisted pair begins anew in each substep

#include "shared/contact_params.h"
#include "shared/deltas.h"
#include "shared/spring.h"

// `lever` is the distance over the sum of the radii. The centres share the distance to the point of contact in
// proportion to the radii.
void applySpringFriction(uint a, uint b, vec3 n, float ra, float rb, float lever, Spring spring, vec4 law) {
    vec4 va = velocity[a];
    vec4 vb = velocity[b];
    vec4 sa = angularVelocity[a];
    vec4 sb = angularVelocity[b];
    vec3 difference = vec3(va) - vec3(vb);
    vec3 slip = difference - n * dot3(difference, n) - cross3(vec3(sa) * ra + vec3(sb) * rb, n) * lever;
    displacement = rotateToPlane(displacement, n);
    float mobility = (va.w + vb.w) * (1.0f + 2.5f * lever * lever);
    vec3 impulse = tangentialImpulse(slip, slip, mobility, spring, law.y);
    vec3 twist = cross3(n, impulse) * (2.5f * lever);
    vec3 moment = vec3(0.0f, 0.0f, 0.0f);
    if (HAS(ROLLING)) {
        float c = 2.5f * (va.w / (ra * ra) + vb.w / (rb * rb));
        float most = ra * rb / (ra + rb) * spring.impulse;
        vec3 omega = vec3(sa) - vec3(sb);
        float about = dot3(omega, n);
        moment = (rollingMoment(omega - n * about, c, law.z * most) + spinningMoment(n, about, c, law.w * most)) * 2.5f;
    }
    // Compilers may factor these differently on each device.
    precise vec3 changeA = moment * (va.w / (ra * ra)) - twist * (va.w / ra);
    precise vec3 changeB = moment * (-vb.w / (rb * rb)) - twist * (vb.w / rb);
    addDeltaVelocity(a, impulse * va.w);
    addDeltaVelocity(b, impulse * -vb.w);
    addDeltaOmega(a, changeA);
    addDeltaOmega(b, changeB);
}

void visitPair(uint a, uint b) {
    vec4 pa = position[a];
    vec4 pb = position[b];
    vec3 d = vec3(pa) - vec3(pb);
    d = d + (vec3(positionLow[a]) - vec3(positionLow[b]));
    float squared = dot3(d, d);
    float ra = HAS(RADII) ? pa.w : params.radius;
    float rb = HAS(RADII) ? pb.w : params.radius;
    float reach = ra + rb;
    touches = squared < reach * reach;
    if (!touches) return;
    if (!listed) displacement = vec3(0.0f, 0.0f, 0.0f);
    vec4 va = velocity[a];
    vec4 vb = velocity[b];
    float inverse = va.w + vb.w;
    vec4 normal = normalAndDistance(d, squared, a, b);
    vec3 n = vec3(normal);
    float speed = dot3(vec3(va) - vec3(vb), n);
    Spring spring = springOf(reach - normal.w, speed, speed, ra * rb / reach, inverse, stiffnessOf(a, b));
    vec3 impulse = n * spring.impulse;
    addDeltaVelocity(a, impulse * va.w);
    addDeltaVelocity(b, impulse * -vb.w);
    if (HAS(FRICTION)) applySpringFriction(a, b, n, ra, rb, normal.w / reach, spring, contactOf(a, b));
}

#include "shared/group.h"

KERNEL(groupsOfPhase()) {
    uint group = groupOfPhase(invocation);
    uvec4 mine = groupRange[group];
    listed = mine.y != UNLISTED;
    if (!listed) {
        visitGroupNumber(group, mine.x);
        return;
    }
    uint touched = 0u;
    for (uint k = mine.x; k < mine.x + mine.y; ++k) {
        uvec2 pair = pairs[k];
        if (HAS(FRICTION)) displacement = vec3(tangentialSlip[k]);
        visitPair(pair.x, pair.y);
        if (touches) touched = touched + 1u;
        if (HAS(FRICTION)) {
            if (touches)
                tangentialSlip[k] = vec4(displacement, 1.0f);
            else if (tangentialSlip[k].w != 0.0f)
                tangentialSlip[k] = vec4(0.0f, 0.0f, 0.0f, 0.0f);
        }
    }
    groupRange[group] = uvec4(mine.x, mine.y, touched, mine.w);
}

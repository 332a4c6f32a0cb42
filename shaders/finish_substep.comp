// Finishes a substep of `balanced`: solves the contacts of each sphere with walls and obstacles (shared/contact_law.h),
// then moves the sphere. Asks for new pair lists if the sphere may leave its margin in the next substep.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/wrap.h"

BUFFER(restrict, vec4, position)
BUFFER(restrict, vec4, velocity)
BUFFER(restrict, vec4, angularVelocity)
BUFFER(readonly, vec4, velocityBefore)
BUFFER(restrict, vec4, unheldVelocity)
BUFFER(restrict, vec4, unheldSpin)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(readonly, ContactParams, contactParams)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(readonly, uint, obstacleLists)
BUFFER(readonly, uvec2, nearObstacles)
BUFFER(restrict, vec4, wallImpulse)  // by id, params.maxWallHistory each: N s; w: surface + 1
BUFFER(restrict, vec4, wallTorque)   // by id: torque of the friction per lever (N s)
BUFFER(readonly, vec4, listReference)
BUFFER(coherent, uint, counters)
BUFFER(coherent, uint, surfaceSums)

#include "shared/contact_law.h"
#include "shared/drift.h"
#include "shared/fields.h"
#include "shared/friction.h"
#include "shared/limits.h"
#include "shared/shapes.h"
#include "shared/moving.h"
#include "shared/outside.h"
#include "shared/falling_frame.h"
#include "shared/mesh_room.h"
#include "shared/ask_for_lists.h"
#include "shared/motion.h"
#include "shared/surface_sums.h"

// The sphere of each lane. Its contacts with walls change it one after the other.
PRIVATE(uints, sphereId)
PRIVATE(mask, sphereAwake)
PRIVATE(real3, spherePoint)     // m
PRIVATE(real, sphereRadius)     // m
PRIVATE(real, inverseMass)      // 1/kg
PRIVATE(uints, sphereMaterial)
PRIVATE(real3, sphereVelocity)  // m/s
PRIVATE(real3, sphereSpin)      // rad/s
PRIVATE(real4, startVelocity)   // its row of `velocityBefore`, continued by impacts
PRIVATE(real3, unheld)          // the velocity without held impulses (m/s)
PRIVATE(real3, unheldTurn)      // the spin without held torques (rad/s)
PRIVATE(real3, heldByWalls)     // the change of velocity by the impulses that contacts with walls hold (m/s)
PRIVATE(real3, spinByWalls)     // the change of spin by them (rad/s)
PRIVATE(real, partsBefore)      // partOfSurface() of the surfaces at which the sphere held an impulse
PRIVATE(real, partsNow)         // the same after the substep
PRIVATE(mask, touchesWalls)
PRIVATE(uints, seenRows)  // a bit for each row of `wallImpulse` whose surface the sphere has visited
PRIVATE(real3, momentOfRolling) // at one surface, about the centre of the sphere (N m s)

// The row of `wallImpulse` for a contact. The first three rows are for the axes of the bounds, the others for obstacles
// that the sphere touches.
uints rowOfSurface(mask where, uint surface, uints key) {
    uints first = sphereId * params.maxWallHistory;
    if (surface < 6u) return first + surface / 2u;
    uints found = first + 3u;
    uints foundBit = uints(0u);
    mask known = noLane();
    mask empty = noLane();
    for (uint k = 3u; k < params.maxWallHistory; ++k) {
        real4 row = ROW(wallImpulse, first + k);
        mask here = isAtSurface(row, key);
        mask usable = !known && (here || (!empty && row.w == 0.0f));
        found = select(usable, first + k, found);
        foundBit = select(usable, uints(1u << k), foundBit);
        known = known || here;
        empty = empty || row.w == 0.0f;
    }
    if (HAS(MESHES)) seenRows = select(where, seenRows | foundBit, seenRows);
    return found;
}

real3 relativeVelocity() {
    if (!HAS(MOTION)) return sphereVelocity;
    return sphereVelocity - surfaceVelocity;
}

// A sphere that has moved on to another part of a mesh holds nothing at the part before. The impulse that it held there
// at the beginning of the substep ends.
RARE void endLeftContacts() {
    uints first = sphereId * params.maxWallHistory;
    for (uint k = 3u; k < params.maxWallHistory; ++k) {
        real4 held = ROW(wallImpulse, first + k);
        mask seen = (seenRows & uints(1u << k)) != uints(0u);
        mask left = sphereAwake && containsPart(partsBefore, 6u) && !seen && held.w != 0.0f;
        if (!anyLane(left)) continue;
        touchesWalls = touchesWalls || left;
        sphereVelocity = select(left, sphereVelocity - real3(held) * inverseMass, sphereVelocity);
        real4 none = real4(0.0f, 0.0f, 0.0f, 0.0f);
        SET_ROW(left, wallImpulse, first + k, none, held)
        if (HAS(FRICTION)) {
            real4 heldTurn = ROW(wallTorque, first + k);
            real lever = inverseMass / sphereRadius * 2.5f;
            sphereSpin = select(left, sphereSpin + real3(heldTurn) * lever, sphereSpin);
            SET_ROW(left, wallTorque, first + k, none, heldTurn)
        }
    }
}

void resistRollingAtWall(mask where, real3 n, real normalImpulse, real4 contact) {
    real3 spin = sphereSpin;
    if (HAS(MOTION)) spin = spin - surfaceSpin;
    real about = dot3(spin, n);
    real c = inverseMass / (sphereRadius * sphereRadius) * 2.5f;
    real most = normalImpulse * sphereRadius;
    real3 moment = rollingMoment(spin - n * about, c, rollingResistanceOf(contact) * most) +
                   spinningMoment(n, about, c, spinningResistanceOf(contact) * most);
    momentOfRolling = moment;
    real3 change = select(where, moment * c, real3(0.0f, 0.0f, 0.0f));
    sphereSpin = sphereSpin + change;
    unheldTurn = unheldTurn + change;
}

void reportDroppedWall(uint id) {
    atomicAdd(counters[COUNTER_DROPPED_WALLS], 1u);
}

// Solves the contacts in `where` with one surface. The spheres meet it in this substep, or they may hold an impulse.
RARE void solveSurface(mask where, mask close, real3 n, real separation, real recession, real speed, uint wallMaterial,
                       uint surface, uints key) {
    float h = params.substep;
    uints row = rowOfSurface(where, surface, key);
    real4 remembered = ROW(wallImpulse, row);
    mask held = isAtSurface(remembered, key);
    mask involved = where && (close || held);

    // A sphere whose row is another surface's holds no impulse here.
    mask remembers = held || remembered.w == 0.0f;
    real3 oldImpulse = select(held, real3(remembered), real3(0.0f, 0.0f, 0.0f));
    real4 oldTorque = real4(0.0f, 0.0f, 0.0f, 0.0f);
    if (HAS(FRICTION)) oldTorque = ROW(wallTorque, row);
    heldTorque = select(held, real3(oldTorque), real3(0.0f, 0.0f, 0.0f));
    real mass = 1.0f / inverseMass;
    real reduced = mass;  // of the sphere and the body that it touches
    real reducedAcross = mass;
    if (HAS(DRIVES) && driveRow != 0u) {
        // Each contact has an equal share of the body, so that all together do not move it too far. After: Tonge,
        // Benevolenski and Voroshilov, "Mass splitting for jitter-free parallel rigid body simulation", 2012.
        float share = driveYield * float(max(surfaceSums[DRIVE_CONTACTS], 1u));
        real along = dot3(driveLever, n);
        real yield = along * along * share;
        reduced = 1.0f / (inverseMass + yield);
        reducedAcross = 1.0f / (inverseMass + max(dot3(driveLever, driveLever) * share - yield, real(0.0f)));
    }
    real before = dot3(oldImpulse, n);
    real3 tangential = oldImpulse - n * before;
    precise real target = -max(separation, real(0.0f)) * params.perSubstep - recession;
    uints index = sphereMaterial * params.materials + wallMaterial;
    real4 contact = MEMBER(contactParams, index, contact);
    real e = HAS(RESTITUTION) ? restitutionOf(contact) : real(0.0f);

    real time = real(0.0f);
    mask impact = noLane();
    mask placed = noLane();
    real load = real(0.0f);  // that the sphere carries towards the wall (N s)
    mask approaching = involved && speed < target;
    if (anyLane(approaching)) {
        real start = dot3(real3(startVelocity), n);
        if (HAS(MOTION)) start = start - dot3(surfaceVelocity, n);
        real acceleration = sqrt(startVelocity.w);
        load = before - dot3(sphereVelocity - unheld, n) * mass;
        load = select(load > -start * mass * LEAST_LOAD, load, real(0.0f));
        real least = -max(acceleration * IMPACT, before * inverseMass * IMPACT_LOAD);
        mask ahead = approaching && separation > 0.0f && start < least;
        real meeting = separation * 2.0f / max(-start - speed, real(1.0e-30f));
        placed = ahead && meeting <= h;
        mask missed = ahead && !placed && !held;
        involved = involved && !missed;
        approaching = approaching && !missed;
        // As in approachOf().
        real change = min(speed - start, real(0.0f));
        precise real energy = start * start - 2.0f * change * separation * params.perSubstep;
        real impactSpeed = select(placed, -sqrt(max(energy, real(0.0f))), min(start, real(0.0f)));
        time = select(placed, min(separation * 2.0f / max(-start - impactSpeed, real(1.0e-30f)), real(h)), real(0.0f));
        precise real late = change * (1.0f - time * params.perSubstep);
        impact = approaching && impactSpeed < least;
        precise real rebound = -e * impactSpeed;
        startVelocity = select(impact, real4(real3(startVelocity) + n * (rebound - impactSpeed), startVelocity.w),
                               startVelocity);
        target = select(placed, real(0.0f), target);
        target = select(impact, max(rebound + late, real(0.0f)), target);
    }

    precise real normalImpulse = positivePart(before - reduced * (speed - target));
    mask soft = isSoft(contact) && separation <= sphereRadius * SOFT_GAP && !impact;
    if (anyLane(soft))
        normalImpulse = select(soft, softImpulse(before, reduced, speed + recession, separation, sphereRadius), normalImpulse);
    mask touching = involved && (normalImpulse > 0.0f || held);
    touchesWalls = touchesWalls || touching;
    // Rigid walls push out fully, because they come after the pairs.
    precise real push = select(soft, real(0.0f), max(-separation - sphereRadius * SLOP, real(0.0f)));

    real3 friction = real3(0.0f, 0.0f, 0.0f);
    real3 torque = real3(0.0f, 0.0f, 0.0f);
    real lever = inverseMass / sphereRadius * 2.5f;
    real3 velocityHeld = sphereVelocity - unheld;
    real3 spinHeld = sphereSpin - unheldTurn;
    momentOfRolling = real3(0.0f, 0.0f, 0.0f);
    if (HAS(FRICTION)) {
        // Before friction: a contact at rest holds the torque of its friction, which rolling resistance bears.
        if (HAS(ROLLING)) resistRollingAtWall(touching, n, normalImpulse, contact);
        precise real3 slip = relativeVelocity() - n * speed - cross3(sphereSpin, n) * sphereRadius;
        friction = frictionOfContact(tangential, slip, reducedAcross, frictionOf(contact) * normalImpulse);
        torque = cross3(n, friction);
        sphereSpin = select(touching, sphereSpin - (torque - heldTorque) * lever, sphereSpin);
    }
    precise real3 change = (n * (normalImpulse - before) + friction - tangential) * inverseMass;
    sphereVelocity = select(touching, sphereVelocity + change, sphereVelocity);
    precise real3 shift = n * push - select(touching, change * time, real3(0.0f, 0.0f, 0.0f));
    spherePoint = select(involved, spherePoint + shift, spherePoint);

    real3 impulse = n * normalImpulse + friction;
    if (HAS(CONTACT_SUMS) || HAS(DRIVES)) {
        precise real3 moment = cross3(spherePoint, impulse) + momentOfRolling - torque * sphereRadius;
        if (HAS(CONTACT_SUMS)) EACH_LANE_VECTORS(touching, addToSurfaceSums, sphereId, surface, impulse, moment)
        if (HAS(DRIVES) && driveRow != 0u)
            EACH_LANE_VECTORS(touching, addToSurfaceSums, sphereId, driveRow, impulse, moment)
    }
    mask forgets = touching && (impact || !remembers);
    if (anyLane(forgets)) {
        real keep = heldAfterImpact(max(before, real(0.0f)), normalImpulse, e, load);
        real share = select(normalImpulse > 0.0f, min(keep / max(normalImpulse, real(1.0e-30f)), real(1.0f)),
                            real(0.0f));
        share = select(forgets, select(remembers, share, real(0.0f)), real(1.0f));
        impulse = impulse * share;
        torque = torque * share;
        // As correctHeld() in shared/contact_pair.h.
        precise real3 heldNow = velocityHeld + (impulse - oldImpulse) * inverseMass;
        precise real3 heldTurn = spinHeld - (torque - heldTorque) * lever;
        unheld = select(forgets, sphereVelocity - heldNow, unheld);
        unheldTurn = select(forgets, sphereSpin - heldTurn, unheldTurn);
    }
    precise real3 heldHere = heldByWalls + impulse * inverseMass;
    heldByWalls = select(touching, heldHere, heldByWalls);
    precise real3 spinHere = spinByWalls - torque * lever;
    spinByWalls = select(touching, spinHere, spinByWalls);
    EACH_LANE(touching && !remembers, reportDroppedWall, sphereId)
    mask stored = touching && remembers;
    mask holds = stored && (impulse.x != 0.0f || impulse.y != 0.0f || impulse.z != 0.0f);
    partsNow = select(holds, withPart(partsNow, surface), partsNow);
    if (HAS(DRIVES) && driveRow != 0u) {
        precise real3 moment = cross3(spherePoint, impulse) - torque * sphereRadius;
        EACH_LANE_VECTORS(holds, addToSurfaceSums, sphereId, driveRow + 1u, impulse, moment)
    }
    real4 kept = real4(impulse, select(holds, real(key + 1u), real(0.0f)));
    SET_ROW(stored, wallImpulse, row, kept, remembered)
    if (HAS(FRICTION)) SET_ROW(stored, wallTorque, row, real4(torque, 0.0f), oldTorque)
}

bool looksAhead() {
    return true;
}

real3 velocityAlong() {
    return sphereVelocity;
}

void visitSurface(mask where, real3 n, real separation, real recession, uint wallMaterial, uint surface, uints key) {
    real speed = dot3(relativeVelocity(), n);
    if (HAS(MOTION)) {
        real motion = -speed * params.substep;
        mask unsafe = where && sphereAwake && separation < motion && motion > sphereRadius * SAFE_MOTION;
        RAISE_TO(unsafe, counters[COUNTER_LARGEST_MOTION], motion / sphereRadius)
    }
    mask close = separation + min(speed + recession, real(0.0f)) * params.substep <= 0.0f;
    mask visited = where && sphereAwake && (close || containsPart(partsBefore, surface));
    if (anyLane(visited)) solveSurface(visited, close, n, separation, recession, speed, wallMaterial, surface, key);
}

// Only `accurate` gathers contacts.
void gather(real4 surface, Obstacle mesh, uint key) {}
void visitGathered(Obstacle mesh) {}

#include "shared/surfaces.h"

void solveWalls(uintRow at) {
    partsNow = real(0.0f);
    touchesWalls = noLane();
    heldByWalls = real3(0.0f, 0.0f, 0.0f);
    spinByWalls = real3(0.0f, 0.0f, 0.0f);
    uints near = uints(NO_OBSTACLES);
    mask visits = partsBefore != 0.0f;
    if (HAS(WALLS) || HAS(OBSTACLES)) {
        real reach = sqrt(dot3(sphereVelocity, sphereVelocity)) * params.substep + sphereRadius * SLOP;
        visits = visits || !clearOfFaces(reach);
        if (HAS(OBSTACLES)) {
            near = select(sphereAwake, obstaclesNear(at, reach), near);
            visits = visits || near != NO_OBSTACLES;
        }
    }
    if (!anyLane(sphereAwake && visits)) return;
    unheld = real3(ROW(unheldVelocity, at));
    if (HAS(FRICTION)) {
        sphereSpin = real3(ROW(angularVelocity, at));
        unheldTurn = real3(ROW(unheldSpin, at));
    }
    if (!HAS(WALLS) && !HAS(OBSTACLES)) return;  // the last surface has gone
    uints word = ROW(idAndMaterial, at);
    sphereId = idOf(word);
    sphereMaterial = HAS(MATERIALS) ? materialOf(word) : uints(params.material);
    startVelocity = ROW(velocityBefore, at);
    seenRows = uints(0u);
    visitSurfaces(near);
    if (HAS(MESHES)) endLeftContacts();
}

void reportNonFinite(uint sphere) {
    // The sphere is counted and reported. It touches nothing, because comparisons with its position are false.
    atomicAdd(counters[COUNTER_NON_FINITE], 1u);
    atomicMax(counters[COUNTER_FIRST_ID], ~idOf(idAndMaterial[sphere]));
}

void checkOutside(uint sphere) {
    vec4 x = position[sphere];
    checkMotion(sphere, x, vec3(velocity[sphere]), vec3(x));
}

LANE_KERNEL(params.spheres) {
    real4 v = ROW(velocity, invocation);
    sphereAwake = liveLanes() && isAwake(v);
    if (!anyLane(sphereAwake)) return;
    float h = params.substep;
    real4 x = ROW(position, invocation);
    real parts = MEMBER(unheldVelocity, invocation, w);
    spherePoint = real3(x);
    sphereRadius = radiusOf(x);
    inverseMass = inverseMassOf(v);
    sphereVelocity = real3(v);
    unheldTurn = sphereSpin = real3(0.0f, 0.0f, 0.0f);
    real pairsHeld = heldPairs(parts);
    partsBefore = parts - pairsHeld;
    solveWalls(invocation);

    // A sphere that holds nothing moves along its arc, which is exact under gravity alone.
    real heldNow = pairsHeld + partsNow;
    mask isFree = heldNow == 0.0f;
    mask changes = sphereAwake && (touchesWalls || partsBefore != 0.0f);
    if (anyLane(changes)) {
        // The difference of velocities has their rounding. It must not add up to a thrust, so the sums of the walls'
        // impulses replace it where the sphere holds nothing else.
        mask byWallsAlone = pairsHeld == 0.0f;
        unheld = select(byWallsAlone, sphereVelocity - heldByWalls, unheld);
        SET_ROW(changes, unheldVelocity, invocation, real4(unheld, heldNow), ROW(unheldVelocity, invocation))
        SET_ROW(touchesWalls, velocity, invocation, real4(sphereVelocity, v.w), v)
        if (HAS(FRICTION)) {
            unheldTurn = select(byWallsAlone, sphereSpin - spinByWalls, unheldTurn);
            SET_ROW(changes, unheldSpin, invocation, real4(unheldTurn, 0.0f), ROW(unheldSpin, invocation))
            real4 spinBefore = ROW(angularVelocity, invocation);
            SET_ROW(touchesWalls, angularVelocity, invocation, real4(sphereSpin, spinBefore.w), spinBefore)
        }
    }
    real3 arc = sphereVelocity;
    if (HAS(FIELDS)) {
        real3 gravity = HAS(GRAVITY) ? real3(params.gravity) : real3(0.0f, 0.0f, 0.0f);
        real3 before = real3(ROW(velocityBefore, invocation));
        real3 mean = meanAcceleration(gravity, spherePoint, before, sphereRadius, inverseMass);
        arc = select(isFree, arc - mean * (0.5f * h), arc);
    } else if (HAS(GRAVITY)) {
        arc = select(isFree, arc - real3(params.gravity) * (0.5f * h), arc);
    }
    precise real3 to = spherePoint + arc * h;
    mask moves = sphereAwake;
    if (HAS(OPEN_FACES)) moves = moves && farthestOf(spherePoint) <= LAST_PLACE;
    SET_ROW(moves, position, invocation, real4(to, x.w), x)
    mask bad = sphereAwake && !finiteLanes(to);
    EACH_LANE(bad, reportNonFinite, invocation)
    mask inside = sphereAwake && !bad;
    real4 reference = HAS(CONTACTS) ? ROW(listReference, invocation) : real4(0.0f, 0.0f, 0.0f, 0.0f);
    if (HAS(OPEN_FACES)) {
        mask outside = inside && ((reference.w != 0.0f && isRoom(reference.w)) || leavesBounds(to));
        inside = inside && !outside;
        EACH_LANE(outside && moves, checkOutside, invocation)
    }
    real motion = sqrt(dot3(arc, arc)) * h;
    RAISE_TO(inside && motion > sphereRadius * SAFE_MOTION, counters[COUNTER_LARGEST_MOTION], motion / sphereRadius)
    if (HAS(CONTACTS)) {  // no function: glslang would need minutes, because `precise` spreads through its parameter
        real3 since = to - real3(reference) - real3(driftPath());
        real3 relative = arc - real3(driftVelocity());
        real moved = sqrt(dot3(since, since));
        real next = sqrt(dot3(relative, relative)) * h;  // in the next substep, to whose end the lists must hold
        real most = moreMotionOf(reference.w) + params.rebuildMove;
        mask soon = inside && moved + mostNext(motion) * SOON_SUBSTEPS > most;
        if (HAS(PERIODIC)) soon = soon || (inside && mustWrap(to + arc * (h * SOON_SUBSTEPS)));
        if (!anyLane(soon)) return;
        mask leaves = inside && moved + next > most;
        if (HAS(PERIODIC)) leaves = leaves || (inside && mustWrap(to));
        askForLists(anyLane(leaves), HAS(PERIODIC));
    }
}

// Solves the contact of two spheres by the law of the model `balanced`. The includer binds `position`, `velocity`,
// `angularVelocity`, `velocityBefore`, `unheldVelocity`, `unheldSpin`, `idAndMaterial` and `contactParams`, and has
// included shared/separation.h, shared/contact_law.h, shared/wake.h and shared/contact_sums.h. It defines
// `readHeldTorque()`, which sets `heldTorque` of the contacts that are solved. Most listed pairs touch nothing and need
// no torque.

RARE real4 contactOfMaterials(slots a, slots b) {
    uints index = materialOf(ROW(idAndMaterial, a)) * params.materials + materialOf(ROW(idAndMaterial, b));
    return MEMBER(contactParams, index, contact);
}

real4 contactOfPair(slots a, slots b) {
    return HAS(MATERIALS) ? contactOfMaterials(a, b) : real4(params.contact);
}

// The impacts of the pairs that approach in this substep. All speeds are along the normal.
struct Impact {
    mask impact;
    mask placed;    // the spheres meet within the substep: the values below are of that moment
    mask missed;    // they pass each other
    real3 n;        // from b to a
    real speed;     // present speed of parting (m/s)
    real target;    // the speed to reach (m/s)
    real lever;     // of friction, over the radius
    real time;      // from the beginning of the substep (s)
    real load;      // that both spheres carry (N s)
};

// Finds the impacts, and lets them change the velocities before the substep: an impact passes from pair to pair as in
// Newton's cradle. `before`: the normal impulse held so far (N s).
RARE Impact impactOf(mask approaching, mask held, slots a, slots b, real3 d, real squared, real reach, real separation,
                     real4 va, real4 vb, real3 normal, real before, real target, real lever, real e) {
    real ma = effectiveInverseMass(va);
    real mb = effectiveInverseMass(vb);
    real mass = 1.0f / max(ma + mb, real(1.0e-30f));
    real3 relative = real3(va) - real3(vb);
    real4 ua = ROW(velocityBefore, a);
    real4 ub = ROW(velocityBefore, b);
    real3 startVelocity = real3(ua) - real3(ub);
    Impact result;
    result.n = normal;
    result.speed = dot3(relative, normal);
    result.target = target;
    result.lever = lever;
    result.time = real(0.0f);
    result.load = real(0.0f);
    result.placed = noLane();
    result.missed = noLane();
    real start = dot3(startVelocity, normal);
    real acceleration = sqrt(max(ua.w, ub.w));
    mask comes = approaching && result.speed < -acceleration;
    real least = -max(acceleration * IMPACT, before / mass * IMPACT_LOAD);
    mask ahead = comes && separation > 0.0f && start < least;
    real impactSpeed = start;
    real late = max(min(result.speed - start, real(0.0f)), -acceleration);  // of an impact at once
    if (anyLane(ahead)) {
        Approach approach = approachOf(d, squared, reach, relative, startVelocity, acceleration);
        mask placed = ahead && approach.found;
        result.placed = placed;
        result.missed = ahead && !approach.found && !held;
        comes = comes && !result.missed;
        result.n = select(placed, approach.n, normal);
        result.speed = select(placed, approach.solved, result.speed);
        result.time = select(placed, approach.time, result.time);
        result.lever = select(placed, real(1.0f), lever);
        result.target = select(placed, real(0.0f), target);
        late = select(placed, approach.late, late);
        impactSpeed = select(placed, approach.speed, impactSpeed);
    }
    result.impact = comes && impactSpeed < least;
    if (!anyLane(result.impact)) return result;
    // The impulses by which the other contacts of each sphere, so far, press it to the other one.
    real heldNow = dot3(heldImpulse, result.n);
    real3 changeA = real3(va) - real3(ROW(unheldVelocity, a));
    real3 changeB = real3(vb) - real3(ROW(unheldVelocity, b));
    real loadA = select(ma > 0.0f, heldNow - dot3(changeA, result.n) / max(ma, real(1.0e-30f)), heldNow);
    real loadB = select(mb > 0.0f, heldNow + dot3(changeB, result.n) / max(mb, real(1.0e-30f)), heldNow);
    real load = min(loadA, loadB);
    if (HAS(FIXED)) {
        // A fixed sphere bears any load.
        load = select(isFixed(va), loadB, load);
        load = select(isFixed(vb), loadA, load);
    }
    result.load = select(load > -impactSpeed * mass * LEAST_LOAD, load, real(0.0f));
    precise real rebound = -e * impactSpeed;
    real3 bounce = result.n * ((rebound - impactSpeed) * mass);
    SET_ROW(result.impact, velocityBefore, a, real4(real3(ua) + bounce * ma, ua.w), ua)
    SET_ROW(result.impact, velocityBefore, b, real4(real3(ub) - bounce * mb, ub.w), ub)
    result.target = select(result.impact, max(rebound + late, real(0.0f)), result.target);
    return result;
}

// Resists rolling and spinning by moments up to the contact's limits. They are not held over substeps.
RARE void resistRolling(mask where, slots a, slots b, real3 n, real4 pa, real4 pb, real ma, real mb, real normalImpulse,
                   real4 contact) {
    real4 sa = ROW(angularVelocity, a);
    real4 sb = ROW(angularVelocity, b);
    real ra = radiusOf(pa);
    real rb = radiusOf(pb);
    real3 omega = real3(sa) - real3(sb);
    where = where && dot3(omega, omega) < LARGEST_SQUARE;
    real about = dot3(omega, n);
    precise real inverseInertia = ma / (ra * ra) + mb / (rb * rb);
    real c = inverseInertia * 2.5f;
    real most = normalImpulse * (ra * rb / (ra + rb));
    real3 moment = rollingMoment(omega - n * about, c, rollingResistanceOf(contact) * most) +
                   spinningMoment(n, about, c, spinningResistanceOf(contact) * most);
    real3 changeA = moment * (2.5f * ma / (ra * ra));
    real3 changeB = moment * (2.5f * mb / (rb * rb));
    precise real3 spinA = real3(sa) + changeA;
    precise real3 spinB = real3(sb) - changeB;
    real4 wa = ROW(unheldSpin, a);
    real4 wb = ROW(unheldSpin, b);
    precise real3 unheldA = spinA - (real3(sa) - real3(wa));  // as in correctHeld()
    precise real3 unheldB = spinB - (real3(sb) - real3(wb));
    SET_ROW(where, angularVelocity, a, real4(spinA, sa.w), sa)
    SET_ROW(where, angularVelocity, b, real4(spinB, sb.w), sb)
    SET_ROW(where, unheldSpin, a, real4(unheldA, wa.w), wa)
    SET_ROW(where, unheldSpin, b, real4(unheldB, wb.w), wb)
}

// Corrects the unheld rows of two spheres, if their contact does not hold the whole change of their velocities, or if
// it begins or ends to hold an impulse. `heldChange`, `torqueChange`: changes of the impulse and the torque that it
// holds. `begins`: 1 if it begins, -1 if it ends. The sums are exact for a sphere that holds nothing.
RARE void correctHeld(mask where, slots a, slots b, real3 heldChange, real3 torqueChange, real begins, real4 va,
                      real4 vb, real4 sa, real4 sb, real leverA, real leverB) {
    real ma = effectiveInverseMass(va);
    real mb = effectiveInverseMass(vb);
    real4 ua = ROW(unheldVelocity, a);
    real4 ub = ROW(unheldVelocity, b);
    precise real3 heldA = (real3(va) - real3(ua)) + heldChange * ma;
    precise real3 heldB = (real3(vb) - real3(ub)) - heldChange * mb;
    SET_ROW(where, unheldVelocity, a, real4(real3(ROW(velocity, a)) - heldA, ua.w + begins), ua)
    SET_ROW(where, unheldVelocity, b, real4(real3(ROW(velocity, b)) - heldB, ub.w + begins), ub)
    if (!HAS(FRICTION)) return;
    real4 wa = ROW(unheldSpin, a);
    real4 wb = ROW(unheldSpin, b);
    precise real3 turnA = (real3(sa) - real3(wa)) - torqueChange * leverA;
    precise real3 turnB = (real3(sb) - real3(wb)) - torqueChange * leverB;
    SET_ROW(where, unheldSpin, a, real4(real3(ROW(angularVelocity, a)) - turnA, wa.w), wa)
    SET_ROW(where, unheldSpin, b, real4(real3(ROW(angularVelocity, b)) - turnB, wb.w), wb)
}

// A sleeper does not move, but the impulses that its contacts hold change. It begins with them when it wakes.
RARE void updateSleeper(mask where, slots sleeper, real4 v, real4 x, real3 impulse, real3 torque) {
    real inverseMass = inverseMassOf(v);
    real4 unheld = ROW(unheldVelocity, sleeper);
    SET_ROW(where, unheldVelocity, sleeper, real4(real3(unheld) - impulse * inverseMass, unheld.w), unheld)
    if (!HAS(FRICTION)) return;
    real4 spin = ROW(unheldSpin, sleeper);
    real lever = inverseMass / radiusOf(x) * 2.5f;
    SET_ROW(where, unheldSpin, sleeper, real4(real3(spin) + torque * lever, spin.w), spin)
}

// Solves the contacts in `where` whose spheres meet in this substep or hold an impulse. Returns those whose impulse has
// changed. `remembers`: false if the contacts cannot hold an impulse, because they are in no list.
mask solvePairs(mask where, slots a, slots b, bool remembers) {
    real4 pa = ROW(position, a);
    real4 pb = ROW(position, b);
    real3 d = separation(real3(pa), real3(pb));
    real squared = dot3(d, d);
    real reach = radiusSum(pa, pb);
    real interest = reach + contactReach;
    mask inReach = squared < interest * interest;
    mask held = heldImpulse.x != 0.0f || heldImpulse.y != 0.0f || heldImpulse.z != 0.0f;
    mask involved = where && (inReach || held);
    if (!anyLane(involved)) return involved;

    real4 va = ROW(velocity, a);
    real4 vb = ROW(velocity, b);
    real ma = effectiveInverseMass(va);
    real mb = effectiveInverseMass(vb);
    involved = involved && ma + mb > 0.0f;
    if (HAS(SLEEP) && !anyLane(involved)) return involved;
    real mass = 1.0f / max(ma + mb, real(1.0e-30f));
    real4 normal = normalAndDistance(d, squared, a, b);
    real3 n = real3(normal);
    real distance = distanceOf(normal);
    real separation = distance - reach;
    real3 relative = real3(va) - real3(vb);
    real speed = dot3(relative, n);
    real before = dot3(heldImpulse, n);  // the normal impulse held so far
    real3 tangential = heldImpulse - n * before;
    precise real target = -max(separation, real(0.0f)) * params.perSubstep;
    real4 contact = contactOfPair(a, b);
    real e = HAS(RESTITUTION) ? restitutionOf(contact) : real(0.0f);

    real radius = smallerRadius(pa, pb);
    real lever = distance / reach;  // of friction, over the radius
    real time = real(0.0f);         // of an impact (s)
    real load = real(0.0f);         // at an impact, that both spheres carry along the normal (N s)
    mask impact = noLane();
    mask placed = noLane();
    mask approaching = involved && inReach && speed < target && speed < -params.gravityChange;
    if (HAS(SLEEP)) {
        mask waits = approaching && (isAsleep(va) || isAsleep(vb)) && speed < -params.wakeSpeed &&
                     speed > -params.perSubstep * radius * MOST_WAIT;
        involved = involved && !waits;
        approaching = approaching && !waits;
    }
    if (anyLane(approaching)) {
        Impact found =
            impactOf(approaching, held, a, b, d, squared, reach, separation, va, vb, n, before, target, lever, e);
        involved = involved && !found.missed;
        impact = found.impact;
        placed = found.placed;
        n = found.n;
        speed = found.speed;
        target = found.target;
        lever = found.lever;
        time = found.time;
        load = found.load;
        before = dot3(heldImpulse, n);
        tangential = heldImpulse - n * before;
    }

    // The normal impulse that reaches the target speed, without pulling. An overlap is removed by moving the spheres.
    precise real normalImpulse = positivePart(before - mass * (speed - target));
    mask soft = isSoft(contact) && separation <= radius * SOFT_GAP && !impact;
    if (anyLane(soft))
        normalImpulse = select(soft, softImpulse(before, mass, speed, separation, radius), normalImpulse);
    normalImpulse = select(inReach, normalImpulse, real(0.0f));
    precise real push = max(-separation - radius * SLOP, real(0.0f)) * OVERLAP_REMOVED;
    push = select(soft, real(0.0f), push);
    mask pushed = involved && push > 0.0f;
    mask touching = involved && (normalImpulse > 0.0f || held);
    if (!anyLane(touching || pushed)) return touching;

    real3 friction = real3(0.0f, 0.0f, 0.0f);
    real3 torque = real3(0.0f, 0.0f, 0.0f);
    real leverA = real(0.0f);
    real leverB = real(0.0f);
    heldTorque = torque;
    real4 sa = real4(0.0f, 0.0f, 0.0f, 0.0f);
    real4 sb = sa;
    if (HAS(FRICTION)) {
        readHeldTorque();
        // Before friction: a contact at rest holds the torque of its friction, which rolling resistance bears.
        if (HAS(ROLLING)) resistRolling(touching, a, b, n, pa, pb, ma, mb, normalImpulse, contact);
        real ra = radiusOf(pa);
        real rb = radiusOf(pb);
        sa = ROW(angularVelocity, a);
        sb = ROW(angularVelocity, b);
        leverA = ma / ra * 2.5f;
        leverB = mb / rb * 2.5f;
        precise real3 slip = relative - n * speed - cross3(real3(sa) * ra + real3(sb) * rb, n) * lever;
        friction = frictionOfContact(tangential, slip, mass, frictionOf(contact) * normalImpulse);
        torque = cross3(n, friction) * lever;
        real3 change = torque - heldTorque;
        SET_ROW(touching, angularVelocity, a, real4(real3(sa) - change * leverA, sa.w), sa)
        SET_ROW(touching, angularVelocity, b, real4(real3(sb) - change * leverB, sb.w), sb)
    }
    precise real3 change = n * (normalImpulse - before) + friction - tangential;
    SET_ROW(touching, velocity, a, real4(real3(va) + change * ma, va.w), va)
    SET_ROW(touching, velocity, b, real4(real3(vb) - change * mb, vb.w), vb)

    // The spheres are placed so that they move with their new velocities from the time of the impact on.
    mask moved = pushed || (placed && touching);
    if (anyLane(moved)) {
        precise real3 shift = n * (push * mass) - change * time;
        SET_ROW(moved, position, a, real4(real3(pa) + shift * ma, pa.w), pa)
        SET_ROW(moved, position, b, real4(real3(pb) - shift * mb, pb.w), pb)
    }

    real3 impulse = n * normalImpulse + friction;
    if (HAS(CONTACT_SUMS)) addToContactSums(touching, n * (lever * reach), impulse, impact);
    mask forgets = touching && (impact || !remembers);
    if (anyLane(forgets)) {
        real keep = heldAfterImpact(max(before, real(0.0f)), normalImpulse, e, load);
        real share = select(normalImpulse > 0.0f, min(keep / max(normalImpulse, real(1.0e-30f)), real(1.0f)),
                            real(0.0f));
        share = remembers ? select(forgets, share, real(1.0f)) : select(forgets, real(0.0f), real(1.0f));
        impulse = impulse * share;
        torque = torque * share;
    }
    mask holds = impulse.x != 0.0f || impulse.y != 0.0f || impulse.z != 0.0f;
    mask corrected = forgets || (touching && ((holds && !held) || (held && !holds)));
    if (anyLane(corrected)) {
        real pairsHeld = select(holds, real(1.0f), real(0.0f)) - select(held, real(1.0f), real(0.0f));
        correctHeld(corrected, a, b, impulse - heldImpulse, torque - heldTorque, pairsHeld, va, vb, sa, sb, leverA,
                    leverB);
    }
    if (HAS(SLEEP)) {
        mask sleepsA = touching && isAsleep(va);
        mask sleepsB = touching && isAsleep(vb);
        if (anyLane(sleepsA)) updateSleeper(sleepsA, a, va, pa, impulse - heldImpulse, torque - heldTorque);
        if (anyLane(sleepsB)) updateSleeper(sleepsB, b, vb, pb, heldImpulse - impulse, torque - heldTorque);
    }
    heldImpulse = select(touching, impulse, heldImpulse);
    heldTorque = select(touching, torque, heldTorque);
    return touching;
}

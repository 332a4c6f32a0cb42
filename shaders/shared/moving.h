// Obstacles that move. `motion` is the row of an obstacle's motion (layout.h). A share of a substep counts from the
// moment of the frames: 1 is a whole substep later. The includer has included shared/shapes.h.

// The surface that is visited (shared/surfaces.h): 0 if it is at rest.
PRIVATE(real3, surfaceVelocity)  // m/s, where the sphere touches it
PRIVATE(real3, surfaceSpin)      // angular velocity (rad/s)
PRIVATE(uint, driveRow)          // of a driven body: the first of its rows in `surfaceSums`; 0: it is none
PRIVATE(real3, driveLever)       // the velocity of the touched place for a rate of 1: no unit, or m
PRIVATE(float, driveYield)       // 1/kg or 1/(kg m^2)

void setSurfaceAtRest() {
    surfaceVelocity = real3(0.0f, 0.0f, 0.0f);
    surfaceSpin = real3(0.0f, 0.0f, 0.0f);
    if (HAS(DRIVES)) driveRow = 0u;
}

bool isMoving(Obstacle obstacle) {
    return HAS(MOTION) && obstacle.motion != 0u;
}

// Turns a vector by the rotation of the share of a substep. A negative share turns it back.
ANY_REAL3 turnedBy(Obstacle motion, ANY_REAL share, ANY_REAL3 vector) {
    // Cayley's formula: exact rotations without sines, about the same axis for each share.
    ANY_REAL3 r = vector;
    r.x = share * motion.frameX.x;
    r.y = share * motion.frameX.y;
    r.z = share * motion.frameX.z;
    ANY_REAL scale = 2.0f / (1.0f + dot3(r, r));
    ANY_REAL3 once = cross3(r, vector);
    precise ANY_REAL3 turned = vector + (once + cross3(r, once)) * scale;
    return turned;
}

// The vector from the pivot to a point (m), at this share of the substep.
ANY_REAL3 fromPivot(Obstacle motion, ANY_REAL share, ANY_REAL3 point) {
    precise ANY_REAL x = point.x - motion.a.x - motion.b.x * share;
    precise ANY_REAL y = point.y - motion.a.y - motion.b.y * share;
    precise ANY_REAL z = point.z - motion.a.z - motion.b.z * share;
    ANY_REAL3 way = point;
    way.x = x;
    way.y = y;
    way.z = z;
    return way;
}

// The velocity of the obstacle's material at a point (m/s), at this share of the substep.
ANY_REAL3 materialVelocity(Obstacle motion, ANY_REAL share, ANY_REAL3 point) {
    ANY_REAL3 arm = fromPivot(motion, share, point);
    ANY_REAL3 r = arm;
    r.x = 2.0f * motion.frameX.x;
    r.y = 2.0f * motion.frameX.y;
    r.z = 2.0f * motion.frameX.z;
    ANY_REAL3 sweep = cross3(r, arm);
    precise ANY_REAL x = (motion.b.x + sweep.x) * params.perSubstep;
    precise ANY_REAL y = (motion.b.y + sweep.y) * params.perSubstep;
    precise ANY_REAL z = (motion.b.z + sweep.z) * params.perSubstep;
    arm.x = x;
    arm.y = y;
    arm.z = z;
    return arm;
}

// The angular velocity of the obstacle (rad/s), with the type of the point.
ANY_REAL3 spinOf(Obstacle motion, ANY_REAL3 point) {
    ANY_REAL3 spin = point;
    spin.x = motion.frameX.x * (2.0f * params.perSubstep);
    spin.y = motion.frameX.y * (2.0f * params.perSubstep);
    spin.z = motion.frameX.z * (2.0f * params.perSubstep);
    return spin;
}

// The velocity of the surface at a point with this normal (m/s): of its material, and of its belt along the surface.
ANY_REAL3 velocityOfSurface(Obstacle motion, ANY_REAL3 point, ANY_REAL3 normal) {
    ANY_REAL3 result = materialVelocity(motion, 0.0f, point);
    ANY_REAL through = normal.x * motion.frameY.x + normal.y * motion.frameY.y + normal.z * motion.frameY.z;
    precise ANY_REAL x = result.x + (motion.frameY.x - normal.x * through);
    precise ANY_REAL y = result.y + (motion.frameY.y - normal.y * through);
    precise ANY_REAL z = result.z + (motion.frameY.z - normal.z * through);
    result.x = x;
    result.y = y;
    result.z = z;
    return result;
}

// Follows a place of the obstacle from a share of the substep back to the moment of the frames (m).
ANY_REAL3 broughtBack(Obstacle motion, ANY_REAL share, ANY_REAL3 point) {
    ANY_REAL3 back = turnedBy(motion, -share, fromPivot(motion, share, point));
    precise ANY_REAL px = motion.a.x + back.x;
    precise ANY_REAL py = motion.a.y + back.y;
    precise ANY_REAL pz = motion.a.z + back.z;
    back.x = px;
    back.y = py;
    back.z = pz;
    return back;
}

// Returns what surfaceAt() found at the moment of the frames, turned to a share of the substep. `any` is any vector.
ANY_REAL4 turnedSurface(Obstacle motion, ANY_REAL share, ANY_REAL4 surface, ANY_REAL3 any) {
    ANY_REAL3 normal = any;
    normal.x = surface.x;
    normal.y = surface.y;
    normal.z = surface.z;
    normal = turnedBy(motion, share, normal);
    return row4(normal.x, normal.y, normal.z, surface.w);
}

// Describes the motion of the surface that is visited, where the sphere touches it.
void setSurfaceMotion(Obstacle motion, real3 point, real3 normal) {
    surfaceVelocity = velocityOfSurface(motion, point, normal);
    surfaceSpin = spinOf(motion, point);
    if (!HAS(DRIVES)) return;
    driveRow = motion.shape == 0u ? 0u : motion.surface;
    driveYield = motion.frameZ.w;
    driveLever = real3(motion.frameZ.x, motion.frameZ.y, motion.frameZ.z);
    if (motion.shape == DRIVE_TURNS) driveLever = cross3(driveLever, fromPivot(motion, 0.0f, point));
}

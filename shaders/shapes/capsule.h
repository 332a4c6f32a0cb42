// A cylinder with half spheres as its ends, around the z axis of its frame: solid, or the space around a hollow one. a:
// half the length of the cylinder (m), and as w the radius (m), negative if it is hollow.
ANY_REAL4 capsuleAt(Obstacle capsule, uint part, ANY_REAL3 point) {
    float h = capsule.a.x;
    ANY_REAL dz = point.z - min(max(point.z, -h), h);
    precise ANY_REAL squared = point.x * point.x + point.y * point.y + dz * dz;
    ANY_REAL fromAxis = sqrt(squared);
    float outward = capsule.a.w < 0.0f ? -1.0f : 1.0f;
    ANY_REAL scale = outward / max(fromAxis, 1.0e-30f);
    precise ANY_REAL distance = fromAxis * outward - capsule.a.w;
    // On the axis, any direction across it leads out.
    return row4(select(squared > 0.0f, point.x * scale, 1.0f), point.y * scale, dz * scale, distance);
}

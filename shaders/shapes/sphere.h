// A solid sphere, or the space around a hollow one. a: the centre (m), and the radius (m), negative if it is hollow.
ANY_REAL4 sphereAt(Obstacle sphere, uint part, ANY_REAL3 point) {
    ANY_REAL dx = point.x - sphere.a.x;
    ANY_REAL dy = point.y - sphere.a.y;
    ANY_REAL dz = point.z - sphere.a.z;
    precise ANY_REAL squared = dx * dx + dy * dy + dz * dz;
    ANY_REAL fromCentre = sqrt(squared);
    float outward = sphere.a.w < 0.0f ? -1.0f : 1.0f;
    ANY_REAL scale = outward / max(fromCentre, 1.0e-30f);
    precise ANY_REAL distance = fromCentre * outward - sphere.a.w;
    // At the centre any direction leads out.
    return row4(dx * scale, dy * scale, select(squared > 0.0f, dz * scale, 1.0f), distance);
}

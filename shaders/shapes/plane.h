// A half-space. a: the normal of its surface, and the offset (m): normal . x = offset on the surface.
ANY_REAL4 planeAt(Obstacle plane, uint part, ANY_REAL3 point) {
    precise ANY_REAL distance =
        plane.a.x * point.x + plane.a.y * point.y + plane.a.z * point.z - plane.a.w;
    return row4(plane.a.x, plane.a.y, plane.a.z, distance);
}

// A part of a mesh of triangles: a plane, a line or a point. shared/mesh_surfaces.h chooses the one that is nearest to a
// sphere, and puts it into `featurePlace` and `featureAlong`.
#define MESH_SHAPE 7u
#define MESH_FRONT 0u   // a plane: its normal, and as w the offset (m): normal . x = offset
#define MESH_BACK 1u    // the same plane, seen from its other side
#define MESH_EDGE 2u    // a line: a point on it (m), and its direction
#define MESH_VERTEX 3u  // a point (m)

PRIVATE(vec4, featurePlace)
PRIVATE(vec4, featureAlong)

// `part`: what the feature is.
ANY_REAL4 meshAt(Obstacle mesh, uint part, ANY_REAL3 point) {
    if (part <= MESH_BACK) {
        float outward = part == MESH_FRONT ? 1.0f : -1.0f;
        precise ANY_REAL above =
            featurePlace.x * point.x + featurePlace.y * point.y + featurePlace.z * point.z - featurePlace.w;
        ANY_REAL zero = min(abs(above), 0.0f);
        return row4(zero + featurePlace.x * outward, zero + featurePlace.y * outward, zero + featurePlace.z * outward,
                    above * outward);
    }
    ANY_REAL dx = point.x - featurePlace.x;
    ANY_REAL dy = point.y - featurePlace.y;
    ANY_REAL dz = point.z - featurePlace.z;
    if (part == MESH_EDGE) {
        precise ANY_REAL along = dx * featureAlong.x + dy * featureAlong.y + dz * featureAlong.z;
        precise ANY_REAL acrossX = dx - along * featureAlong.x;
        precise ANY_REAL acrossY = dy - along * featureAlong.y;
        precise ANY_REAL acrossZ = dz - along * featureAlong.z;
        dx = acrossX;
        dy = acrossY;
        dz = acrossZ;
    }
    precise ANY_REAL squared = dx * dx + dy * dy + dz * dz;
    ANY_REAL distance = sqrt(squared);
    ANY_REAL inverse = 1.0f / max(distance, 1.0e-30f);
    return row4(dx * inverse, dy * inverse, select(squared > 0.0f, dz * inverse, 1.0f), distance);
}

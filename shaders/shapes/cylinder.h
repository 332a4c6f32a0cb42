// A solid cylinder, or the space around a hollow one, which has three parts: the side and the two ends. a: the centre
// (m), and the radius (m), negative if it is hollow. b: the axis, of unit length, and half the length (m).
ANY_REAL4 cylinderAt(Obstacle cylinder, uint part, ANY_REAL3 point) {
    float axisX = cylinder.b.x;
    float axisY = cylinder.b.y;
    float axisZ = cylinder.b.z;
    float radius = abs(cylinder.a.w);
    ANY_REAL dx = point.x - cylinder.a.x;
    ANY_REAL dy = point.y - cylinder.a.y;
    ANY_REAL dz = point.z - cylinder.a.z;
    precise ANY_REAL along = dx * axisX + dy * axisY + dz * axisZ;
    // The way from the axis to the point: its unit vector and its length.
    precise ANY_REAL x = dx - along * axisX;
    precise ANY_REAL y = dy - along * axisY;
    precise ANY_REAL z = dz - along * axisZ;
    precise ANY_REAL squared = x * x + y * y + z * z;
    ANY_REAL fromAxis = sqrt(squared);
    ANY_REAL inverse = 1.0f / max(fromAxis, 1.0e-30f);
    x = x * inverse;
    y = y * inverse;
    z = z * inverse;
    ANY_MASK onAxis = !(squared > 0.0f);
    if (anyLane(onAxis)) {
        // Any direction across the axis.
        bool acrossX = abs(axisX) < 0.6f;
        float acrossA = acrossX ? axisY : axisX;
        float length = sqrt(acrossA * acrossA + axisZ * axisZ);
        x = select(onAxis, acrossX ? 0.0f : -axisZ / length, x);
        y = select(onAxis, acrossX ? axisZ / length : 0.0f, y);
        z = select(onAxis, (acrossX ? -axisY : axisX) / length, z);
    }
    if (cylinder.a.w < 0.0f) {
        if (part == 0u) {
            precise ANY_REAL toSide = radius - fromAxis;
            return row4(-x, -y, -z, toSide);
        }
        float inward = part == 1u ? 1.0f : -1.0f;  // part 1 is the end from which the axis points inward
        precise ANY_REAL toEnd = cylinder.b.w + along * inward;
        return row4(axisX * inward, axisY * inward, axisZ * inward, toEnd);
    }
    // Beyond the side, beyond an end, beyond the edge between them, or inside: out through the nearest of the two.
    precise ANY_REAL beyondSide = fromAxis - radius;
    precise ANY_REAL beyondEnd = abs(along) - cylinder.b.w;
    ANY_REAL side = max(beyondSide, 0.0f);
    ANY_REAL end = max(beyondEnd, 0.0f);
    precise ANY_REAL square = side * side + end * end;
    ANY_MASK inside = !(square > 0.0f);
    ANY_REAL distance = sqrt(square);
    ANY_REAL scale = 1.0f / max(distance, 1.0e-30f);
    ANY_MASK throughSide = beyondSide > beyondEnd;
    ANY_REAL across = select(inside, select(throughSide, 1.0f, 0.0f), side * scale);
    ANY_REAL up = select(inside, select(throughSide, 0.0f, 1.0f), end * scale);
    up = select(along < 0.0f, -up, up);
    precise ANY_REAL normalX = x * across + axisX * up;
    precise ANY_REAL normalY = y * across + axisY * up;
    precise ANY_REAL normalZ = z * across + axisZ * up;
    return row4(normalX, normalY, normalZ, select(inside, max(beyondSide, beyondEnd), distance));
}

// A thin surface around the z axis of its frame: a disc, or the side of a cylinder or cone without ends. Both of its
// sides are free. a: its radii at z = -h and z = h (m), h (m), and the length of the line from one to the other (m). b:
// a normal of this line in the plane through the axis (across, along), and its direction. It has five parts (see
// AROUND_AXIS), except a disc without a hole.
ANY_REAL4 shellAt(Obstacle shell, uint part, ANY_REAL3 point) {
    float low = shell.a.x;
    float high = shell.a.y;
    float h = shell.a.z;
    ANY_REAL4 across = acrossAxis(point);
    ANY_REAL z = point.z;
    ANY_REAL rho = across.z;
    precise ANY_REAL above = (rho - low) * shell.b.x + (z + h) * shell.b.y;
    precise ANY_REAL along = (rho - low) * shell.b.z + (z + h) * shell.b.w;
    ANY_MASK atLow = along < 0.0f;
    ANY_MASK atHigh = along > shell.a.w;
    ANY_MASK atEdge = atLow || atHigh;
    ANY_REAL dRho = rho - select(atLow, low, high);
    ANY_REAL dZ = z - select(atLow, -h, h);
    precise ANY_REAL squared = dRho * dRho + dZ * dZ;
    ANY_REAL distance = select(atEdge, sqrt(squared), abs(above));
    if (part == 0u) {
        ANY_REAL inverse = 1.0f / max(distance, 1.0e-30f);
        ANY_REAL side = select(above < 0.0f, -1.0f, 1.0f);
        ANY_REAL aside = select(atEdge, dRho * inverse, side * shell.b.x);
        ANY_REAL up = select(atEdge, dZ * inverse, side * shell.b.y);
        if (shell.parts > 1u) distance = select(isCentred(rho, distance), FAR_AWAY, distance);
        return row4(across.x * aside, across.y * aside, up, distance);
    }
    // At a chosen direction from the axis: the edge is a point there, and the side is its tangential plane.
    ANY_MASK there = isNearAxis(rho, distance);
    ANY_MASK inHollow = above < (h > 0.0f ? 0.0f : -FAR_AWAY);
    float x = xOfPart(part);
    float y = yOfPart(part);
    precise ANY_REAL toward = point.x * x + point.y * y;
    precise ANY_REAL beside = point.y * x - point.x * y;
    precise ANY_REAL aboveThere = (toward - low) * shell.b.x + (z + h) * shell.b.y;
    precise ANY_REAL alongThere = (toward - low) * shell.b.z + (z + h) * shell.b.w;
    atLow = alongThere < 0.0f;
    atHigh = alongThere > shell.a.w;
    atEdge = atLow || atHigh;
    ANY_REAL ring = select(atLow, low, high);
    dRho = toward - ring;
    dZ = z - select(atLow, -h, h);
    precise ANY_REAL squaredThere = dRho * dRho + beside * beside + dZ * dZ;
    distance = select(atEdge, sqrt(squaredThere), -aboveThere);
    there = there && ((atEdge && ring > 0.0f) || (!atEdge && inHollow));
    ANY_REAL scale = 1.0f / max(distance, 1.0e-30f);
    ANY_REAL aside = select(atEdge, dRho * scale, -shell.b.x);
    ANY_REAL turn = select(atEdge, beside * scale, 0.0f);
    ANY_REAL up = select(atEdge, dZ * scale, -shell.b.y);
    return row4(aside * x - turn * y, aside * y + turn * x, up, select(there, distance, FAR_AWAY));
}

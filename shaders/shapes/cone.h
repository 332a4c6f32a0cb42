// A truncated cone around the z axis of its frame, between the planes z = -h and z = h: solid, or the space around a
// hollow one. A hollow one has seven parts: the side (see AROUND_AXIS), then its two ends. a: the radii at both ends
// (m), h (m), and the length of its slanted side (m), negative if it is hollow. b: the outward normal of the side, and
// the direction of the side from z = -h to z = h. Both are in the plane through the axis: across, along.
ANY_REAL4 coneAt(Obstacle cone, uint part, ANY_REAL3 point) {
    float low = cone.a.x;
    float high = cone.a.y;
    float h = cone.a.z;
    ANY_REAL4 across = acrossAxis(point);
    ANY_REAL z = point.z;
    if (cone.a.w < 0.0f) {
        if (part == AROUND_AXIS) return row4(across.w, across.w, across.w + 1.0f, z + h);
        if (part > AROUND_AXIS) return row4(across.w, across.w, across.w - 1.0f, h - z);
        precise ANY_REAL inside = (low - across.z) * cone.b.x - (z + h) * cone.b.y;
        if (part == 0u)
            return row4(across.x * -cone.b.x, across.y * -cone.b.x, across.w - cone.b.y,
                        select(isCentred(across.z, inside), FAR_AWAY, inside));
        float x = xOfPart(part);
        float y = yOfPart(part);
        precise ANY_REAL there = (low - point.x * x - point.y * y) * cone.b.x - (z + h) * cone.b.y;
        return row4(across.w - x * cone.b.x, across.w - y * cone.b.x, across.w - cone.b.y,
                    select(isNearAxis(across.z, inside), there, FAR_AWAY));
    }
    ANY_REAL rho = across.z;
    precise ANY_REAL beyondSide = (rho - low) * cone.b.x + (z + h) * cone.b.y;
    precise ANY_REAL along = (rho - low) * cone.b.z + (z + h) * cone.b.w;
    ANY_REAL beyondHigh = z - h;
    ANY_REAL beyondLow = -h - z;
    ANY_REAL beyondEnd = max(beyondHigh, beyondLow);
    ANY_REAL end = select(beyondHigh > beyondLow, 1.0f, -1.0f);
    ANY_MASK atHigh = beyondHigh > beyondLow;
    ANY_MASK inside = beyondSide <= 0.0f && beyondEnd <= 0.0f;
    // Outside it is nearest to an end, to the side or to the edge between them; inside, the way out leads through the
    // nearest of the first two.
    ANY_MASK toEnd = select(atHigh, rho - high, rho - low) <= 0.0f && beyondEnd > 0.0f;
    ANY_MASK toSide = beyondSide > 0.0f && along >= 0.0f && along <= cone.a.w;
    toEnd = toEnd || (inside && beyondEnd > beyondSide);
    toSide = (toSide || inside) && !toEnd;
    ANY_MASK highEdge = along > cone.a.w * 0.5f;
    ANY_REAL dRho = rho - select(highEdge, high, low);
    ANY_REAL dZ = z - select(highEdge, h, -h);
    precise ANY_REAL squared = dRho * dRho + dZ * dZ;
    ANY_REAL distance = sqrt(squared);
    ANY_REAL inverse = 1.0f / max(distance, 1.0e-30f);
    ANY_REAL aside = select(toEnd, 0.0f, select(toSide, cone.b.x, dRho * inverse));
    ANY_REAL up = select(toEnd, end, select(toSide, cone.b.y, dZ * inverse));
    distance = select(toEnd, beyondEnd, select(toSide, beyondSide, distance));
    return row4(across.x * aside, across.y * aside, up, distance);
}

// A box along the axes: solid, or the space around a hollow one, whose six parts are its faces. a, b: its corners (m);
// the w of a is -1 if it is hollow.
ANY_REAL4 boxAt(Obstacle box, uint part, ANY_REAL3 point) {
    if (box.a.w < 0.0f) {
        uint axis = part / 2u;
        ANY_REAL place = axis == 0u ? point.x : axis == 1u ? point.y : point.z;
        float low = axis == 0u ? box.a.x : axis == 1u ? box.a.y : box.a.z;
        float high = axis == 0u ? box.b.x : axis == 1u ? box.b.y : box.b.z;
        float inward = part % 2u == 0u ? 1.0f : -1.0f;
        ANY_REAL zero = min(abs(point.x), 0.0f);
        ANY_REAL along = zero + inward;
        return row4(axis == 0u ? along : zero, axis == 1u ? along : zero, axis == 2u ? along : zero,
                    part % 2u == 0u ? place - low : high - place);
    }
    ANY_REAL dx = point.x - min(max(point.x, box.a.x), box.b.x);
    ANY_REAL dy = point.y - min(max(point.y, box.a.y), box.b.y);
    ANY_REAL dz = point.z - min(max(point.z, box.a.z), box.b.z);
    precise ANY_REAL squared = dx * dx + dy * dy + dz * dz;
    ANY_REAL distance = sqrt(squared);
    ANY_REAL inverse = 1.0f / max(distance, 1.0e-30f);
    ANY_REAL4 surface = row4(dx * inverse, dy * inverse, dz * inverse, distance);
    ANY_MASK inside = !(squared > 0.0f);
    if (anyLane(inside)) {
        // The way out leads through the nearest side.
        ANY_REAL toLowX = box.a.x - point.x;
        ANY_REAL toLowY = box.a.y - point.y;
        ANY_REAL toLowZ = box.a.z - point.z;
        ANY_REAL x = max(toLowX, point.x - box.b.x);
        ANY_REAL y = max(toLowY, point.y - box.b.y);
        ANY_REAL z = max(toLowZ, point.z - box.b.z);
        ANY_REAL nearest = max(x, max(y, z));
        ANY_MASK alongX = x == nearest;
        ANY_MASK alongY = !alongX && y == nearest;
        ANY_REAL outX = select(x == toLowX, -1.0f, 1.0f);
        ANY_REAL outY = select(y == toLowY, -1.0f, 1.0f);
        ANY_REAL outZ = select(z == toLowZ, -1.0f, 1.0f);
        surface = select(inside, row4(select(alongX, outX, 0.0f), select(alongY, outY, 0.0f),
                                      select(alongX || alongY, 0.0f, outZ), nearest), surface);
    }
    return surface;
}

// The cells of a finer level that a sphere reaches: rows along x, each of which is one stretch of a ring of cells.

struct CellRun {
    float from;  // the first cell, before it is wrapped
    uint start;  // the same on the ring
    uint count;  // at most all cells of the ring, so that none comes twice
};

CellRun cellRunOf(float centre, float reach, uint cells) {
    CellRun s;
    s.from = floor(centre - reach);
    s.count = uint(min(floor(centre + reach) - s.from, float(cells - 1u))) + 1u;
    s.start = s.count == cells ? 0u : wrapCell(s.from, cells);
    return s;
}

// How far the centre is from the cells number `index` of the stretch; 0 where these are the whole ring, which lies around
// it more than once.
float distanceTo(CellRun s, uint index, float centre, uint cells) {
    if (s.count == cells) return 0.0f;
    return max(abs(s.from + float(index) + 0.5f - centre) - 0.5f, 0.0f);
}

uint onRing(uint place, uint cells) {
    return place >= cells ? place - cells : place;
}

struct Reach {
    uvec4 cells;  // of the finer level
    vec3 centre;  // in its cells, as is the radius
    float radius;
    CellRun y;
    CellRun z;
    uint rows;
};

Reach reachOf(vec4 sphere, uint level) {
    Reach r;
    r.cells = cellsOf(level);
    r.centre = vec3(sphere) * inverseCellOf(level);
    // A little more than it is, for what rounding makes of the others' cells.
    float farthest = max(max(abs(r.centre.x), abs(r.centre.y)), abs(r.centre.z));
    r.radius = (sphere.w + params.levelSize[level].y + params.margin) * inverseCellOf(level) * 1.0001f + 0.01f +
               farthest * 1.0e-6f;
    r.rows = 0u;
    if (!finite3(r.centre)) return r;
    r.y = cellRunOf(r.centre.y, r.radius, r.cells.y);
    r.z = cellRunOf(r.centre.z, r.radius, r.cells.z);
    r.rows = r.y.count * r.z.count;
    return r;
}

// First cell of the row at `y` and `z` of the sphere's stretches, and where on the row it reaches: the chord of a ball.
// None: a count of 0.
uint rowStart(Reach r, uint y, uint z) {
    return cellIndex(r.cells, 0u, onRing(r.y.start + y, r.cells.y), onRing(r.z.start + z, r.cells.z));
}

CellRun rowRun(Reach r, uint rowY, uint rowZ) {
    float y = distanceTo(r.y, rowY, r.centre.y, r.cells.y);
    float z = distanceTo(r.z, rowZ, r.centre.z, r.cells.z);
    precise float squared = r.radius * r.radius - y * y - z * z;
    CellRun s;
    s.from = 0.0f;
    s.start = 0u;
    s.count = 0u;
    if (squared >= 0.0f) s = cellRunOf(r.centre.x, sqrt(squared), r.cells.x);
    return s;
}

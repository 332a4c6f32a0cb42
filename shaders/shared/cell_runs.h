// The cells of a finer level that a sphere reaches: rows along x. The cells of a row are a run on a ring of cells.

struct CellRun {
    float from;  // the first cell, before wrapping
    uint start;  // the first cell on the ring
    uint count;  // at most all cells of the ring, so that no cell comes twice
};

CellRun cellRunOf(float centre, float reach, uint cells) {
    CellRun s;
    s.from = floor(centre - reach);
    s.count = uint(min(floor(centre + reach) - s.from, float(cells - 1u))) + 1u;
    s.start = s.count == cells ? 0u : wrapCell(s.from, cells);
    return s;
}

// The distance of the centre from cell `index` of the run, in cells. Returns 0 if the run is the whole ring: the reach
// may then go around the ring more than once.
float distanceTo(CellRun s, uint index, float centre, uint cells) {
    if (s.count == cells) return 0.0f;
    return max(abs(s.from + float(index) + 0.5f - centre) - 0.5f, 0.0f);
}

uint onRing(uint place, uint cells) {
    return place >= cells ? place - cells : place;
}

struct Reach {
    uvec4 cells;  // of the finer level
    vec3 centre;  // in cells of that level, like the radius, which is in the narrowest
    float radius;
    CellRun y;
    CellRun z;
    uint rows;
};

// `more`: a distance (m) beyond the margin.
Reach reachOf(vec4 sphere, uint level, float more) {
    Reach r;
    r.cells = cellsOf(level);
    r.centre = vec3(sphere) * inverseCellsOf(level);
    // A little more than the exact radius, because the cells of the other spheres are rounded.
    float farthest = max(max(abs(r.centre.x), abs(r.centre.y)), abs(r.centre.z));
    r.radius = (storedRadius(sphere) + largestRadius(level) + params.margin + more) * inverseCellOf(level) * 1.0001f + 0.01f +
               farthest * 1.0e-6f;
    r.rows = 0u;
    if (!finite3(r.centre)) return r;
    r.y = cellRunOf(r.centre.y, r.radius, r.cells.y);
    r.z = cellRunOf(r.centre.z, r.radius, r.cells.z);
    r.rows = r.y.count * r.z.count;
    return r;
}

// The first cell of row (`y`, `z`) of the sphere's runs.
uint rowStart(Reach r, uint y, uint z) {
    return cellIndex(r.cells, 0u, onRing(r.y.start + y, r.cells.y), onRing(r.z.start + z, r.cells.z));
}

// The run of cells that the sphere reaches on the row: the chord of a ball. Its count is 0 if the ball misses the row.
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

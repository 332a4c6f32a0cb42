// A grid over the domain with SLOTS slots per cell. A sphere outside the domain belongs to the nearest cell.

uvec3 cellAt(vec3 point) {
    vec3 extent = vec3(params.wallMax) - vec3(params.wallMin);
    vec3 cells = vec3(float(params.cells.x), float(params.cells.y), float(params.cells.z));
    vec3 place = (point - vec3(params.wallMin)) * cells / extent;
    return uvec3(uint(min(max(place.x, 0.0f), cells.x - 1.0f)), uint(min(max(place.y, 0.0f), cells.y - 1.0f)),
                 uint(min(max(place.z, 0.0f), cells.z - 1.0f)));
}

uint cellNumber(uint x, uint y, uint z) {
    return (z * params.cells.y + y) * params.cells.x + x;
}

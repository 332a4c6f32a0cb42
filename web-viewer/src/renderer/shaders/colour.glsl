// The expressions of model/quantities.ts may use these inputs, position.glsl, and `position`: the centre
// of the sphere (m, relative to the centre of the bounds).
in vec4 a_group;                // sRGB
in float a_id;                  // negative: the id is the number of the place

uniform int u_mode;             // index of model/quantities.ts
uniform vec3 u_ramp[6];         // sRGB
uniform vec2 u_range;
uniform bool u_speedsSent;      // the two states have speeds
uniform float u_inverseTime;    // 1/s, inverse of the time between the two states; 0: unknown
uniform vec3 u_cellSize;        // m, per axis; 0: no grid
uniform ivec3 u_cells;

vec3 rampAt(float at) {
    float scaled = clamp(at, 0.0, 1.0) * 5.0;
    int index = min(int(scaled), 4);
    return mix(u_ramp[index], u_ramp[index + 1], scaled - float(index));
}

// The colour of a value on the scale.
vec3 colourOf(float value) { return rampAt((value - u_range.x) / max(u_range.y - u_range.x, 1e-12)); }

uint scrambled(uint x) {
    x ^= x >> 16; x *= 0x7feb352du;
    x ^= x >> 15; x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

float id() { return a_id < 0.0 ? float(gl_InstanceID) : a_id; }

// m/s; 0 if it is unknown. See shownSpeed() of model/positions.ts.
float speedNow() {
    if (u_speedsSent) return mix(a_speedFrom, a_speedTo, u_mix);
    return length(shortest(a_positionTo - a_positionFrom)) * u_inverseTime;
}

// The hue of a cell is random; its lightness alternates between neighbours.
vec3 cellColour(vec3 position) {
    if (u_cellSize.x <= 0.0) return vec3(0.62, 0.66, 0.70);
    ivec3 cell = ivec3(floor(position / u_cellSize));
    cell = ((cell % u_cells) + u_cells) % u_cells;
    uint hash = scrambled(uint(cell.x + u_cells.x * (cell.y + u_cells.y * cell.z)));
    float hue = float(hash & 1023u) * (6.2831853 / 1024.0);
    float lightness = 0.60 + 0.10 * float((cell.x + cell.y + cell.z) & 1);
    return vec3(lightness) + 0.17 * vec3(cos(hue), cos(hue - 2.0944), cos(hue + 2.0944));
}

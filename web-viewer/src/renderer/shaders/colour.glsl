// The expressions of model/quantities.ts may use the functions of this file, spheres.glsl and place.glsl. They may use
// `place`, and `position`: the centre of the sphere (m, relative to the centre of the bounds).
uniform sampler2D u_id;
uniform bool u_idsGiven;              // false: the id is the number of the place
uniform usampler2D u_group;     // number of the group at each place
uniform sampler2D u_looks;      // three texels per group: colour and roughness; metal and 1 if fixed; material

uniform int u_mode;             // index of model/quantities.ts
uniform vec3 u_ramp[6];         // sRGB
uniform vec2 u_range;
uniform bool u_valuesSent;      // the two states have the quantity of the mode
uniform float u_inverseTime;    // 1/s, inverse of the time between the two states; 0: unknown
uniform float u_bottom;         // m, of the bounds, relative to their centre
uniform vec3 u_cellSize;        // m, per axis; 0: no grid
uniform ivec3 u_cells;

// How the spheres of a group look.
struct Look {
    vec3 colour;        // sRGB
    float roughness;    // 0..1
    float metal;        // 0..1
    bool moves;
    vec3 material;      // its colour, sRGB
};

Look lookOf(int place) {
    uint group = texelFetch(u_group, texelOf(place), 0).r;
    if (group == 0xffffffffu) return Look(vec3(0.63), 0.5, 0.0, true, vec3(0.63));
    vec4 first = texelFetch(u_looks, texelOf(3 * int(group)), 0);
    vec2 second = texelFetch(u_looks, texelOf(3 * int(group) + 1), 0).rg;
    vec3 material = texelFetch(u_looks, texelOf(3 * int(group) + 2), 0).rgb;
    return Look(first.rgb, first.a, second.r, second.g == 0.0, material);
}

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

float idOf(int place) { return u_idsGiven ? texelFetch(u_id, texelOf(place), 0).r : float(place); }

// The colour of a quantity that the server sends.
vec3 sentColour(int place) {
    if (!u_valuesSent) return vec3(0.62, 0.66, 0.70);
    return colourOf(mix(valueFrom(place), valueTo(place), u_mix));
}

// m/s; 0 if it is unknown. See shownSpeed() of model/positions.ts.
float speedNow(int place) {
    if (u_valuesSent) return mix(valueFrom(place), valueTo(place), u_mix);
    vec3 from = fromEye(positionFrom(place), 0);
    return length(shortest(fromEye(positionTo(place), 1) - from)) * u_inverseTime;
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

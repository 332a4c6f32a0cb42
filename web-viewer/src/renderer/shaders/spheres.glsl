// The spheres, from tables by place (renderer/spheres.ts). Lengths in m. program.ts declares the tables of the columns.
const int tableWidth = 2048;    // as in renderer/table.ts

// Positions are whole numbers of quanta, relative to the centre of the bounds. Each of the two states has quanta of its
// own. In both, the eye is at u_eyes * u_quanta + u_rest. See renderer/grids.ts.
uniform vec3 u_quanta[2];    // m
uniform vec3 u_rest[2];      // m
uniform ivec3 u_eyes[2];
uniform ivec3 u_lengths[2];  // length of each periodic axis; 0: positions do not repeat
uniform sampler2D u_radius;  // 0: no sphere is at this place
uniform float u_sameRadius;  // of all spheres; 0: see u_radius
uniform float u_mix;         // between the two states
uniform vec3 u_period;       // length of each periodic axis; 0: not periodic
uniform vec3 u_perLength;    // 1/m: 1 over these lengths, or 0

ivec2 texelOf(int place) { return ivec2(place & (tableWidth - 1), place / tableWidth); }

float radiusOf(int place) {
    return u_sameRadius > 0.0 ? u_sameRadius : texelFetch(u_radius, texelOf(place), 0).r;
}

// The lengths of the periodic axes, as whole numbers, in a distance: what is left is at most half a length.
vec3 turnsIn(vec3 distance) { return floor(distance * u_perLength + 0.5); }

// A distance by the shortest way along periodic axes.
vec3 shortest(vec3 distance) { return distance - u_period * turnsIn(distance); }

// A position of a state (`end`: 0 or 1) relative to the eye; along periodic axes, of the image that is nearest to the
// eye. Integers are subtracted, and only their difference becomes a float. So the rounding of float32 is a share of the
// distance from the eye, not from the centre of the bounds. Positions of both states are relative to the same eye, so
// they can be mixed, whatever their quanta.
vec3 fromEye(ivec3 units, int end) {
    ivec3 off = units - u_eyes[end];
    vec3 turns = clamp(turnsIn(vec3(off) * u_quanta[end] - u_rest[end]), -1.0, 1.0);
    return vec3(off - ivec3(turns) * u_lengths[end]) * u_quanta[end] - u_rest[end];
}

// The spheres, from tables by place (renderer/spheres.ts). Lengths in m; positions are relative to the centre of the
// bounds. program.ts declares the tables of the columns.
const int tableWidth = 2048;    // as in renderer/table.ts

uniform highp sampler2D u_radius;    // 0: no sphere is at this place
uniform float u_sameRadius;          // of all spheres; 0: see u_radius
uniform float u_mix;                 // between the two states
uniform vec3 u_period;               // length of each periodic axis; 0: not periodic
uniform vec3 u_perLength;            // 1/m: 1 over these lengths, or 0

ivec2 texelOf(int place) { return ivec2(place & (tableWidth - 1), place / tableWidth); }

float radiusOf(int place) {
    return u_sameRadius > 0.0 ? u_sameRadius : texelFetch(u_radius, texelOf(place), 0).r;
}

// A distance by the shortest way along periodic axes.
vec3 shortest(vec3 distance) { return distance - u_period * floor(distance * u_perLength + 0.5); }

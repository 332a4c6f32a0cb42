// Where a sphere is: the mix of two states in units of the wire grid.
in uvec3 a_from;
in uvec3 a_to;
in float a_radius;

uniform vec3 u_origin;     // m
uniform float u_quantum;   // m
uniform float u_mix;

vec3 centreNow() { return u_origin + u_quantum * mix(vec3(a_from), vec3(a_to), u_mix); }

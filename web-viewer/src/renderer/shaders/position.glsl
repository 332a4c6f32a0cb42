// The position of a sphere (m): two states, interpolated.
in vec3 a_from;
in vec3 a_to;
in float a_radius;

uniform vec3 u_origin;     // m
uniform float u_mix;

vec3 centreNow() { return u_origin + mix(a_from, a_to, u_mix); }

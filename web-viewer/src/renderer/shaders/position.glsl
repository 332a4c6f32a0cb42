// The position of a sphere (m): two states, interpolated. program.ts declares the inputs of the columns.
in float a_radius;

uniform vec3 u_origin;     // m
uniform float u_mix;

vec3 centreNow() { return u_origin + mix(a_positionFrom, a_positionTo, u_mix); }

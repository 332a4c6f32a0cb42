// One instance per segment of a path: a strip that faces the eye. Older segments are fainter.
in vec3 a_position;    // begin (m)
in vec3 a_normal;      // end (m)

uniform float u_halfWidth;    // px
uniform float u_first;        // number of the first segment of this call
uniform float u_total;        // segments of the path

out float v_strength;

void main() {
    vec3 at = ((gl_VertexID & 1) == 0 ? a_position : a_normal) - eye.xyz;
    vec3 aside = cross(a_normal - a_position, isOrthographic() ? forward.xyz : at);
    float side = (gl_VertexID & 2) == 0 ? -1.0 : 1.0;
    float size = length(aside);
    if (size > 0.0) at += (side * u_halfWidth * pixelAt(length(at)) / size) * aside;
    float age = u_total - u_first - float(gl_InstanceID);
    v_strength = 1.0 - 0.85 * min(1.0, age / 2048.0);    // as `capacity` in model/trace.ts
    gl_Position = toClip * vec4(at, 1.0);
}

// Spheres are drawn as discs through their centres that face the light, so that no sphere shades its own lit side.
uniform mat4 u_light;
uniform vec3 u_right;
uniform vec3 u_up;

out vec2 v_corner;

void main() {
    v_corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    if (!isDrawn()) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        return;
    }
    gl_Position = u_light * vec4(centreNow() + a_radius * (v_corner.x * u_right + v_corner.y * u_up), 1.0);
}

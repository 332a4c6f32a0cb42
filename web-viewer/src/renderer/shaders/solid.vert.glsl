in vec3 a_position;
in vec3 a_normal;
in vec4 a_colour;    // sRGB

uniform mat4 u_matrix;
uniform vec3 u_from;    // m: u_matrix takes positions relative to this point

out vec3 v_position;
out vec3 v_normal;
out vec4 v_colour;

void main() {
    v_position = a_position;
    v_normal = a_normal;
    v_colour = vec4(a_colour.rgb * a_colour.rgb, a_colour.a);
    gl_Position = u_matrix * vec4(a_position - u_from, 1.0);
}

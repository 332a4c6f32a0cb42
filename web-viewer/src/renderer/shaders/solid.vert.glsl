in vec3 a_place;
in vec3 a_normal;
in vec4 a_colour;    // sRGB

uniform mat4 u_matrix;

out vec3 v_place;
out vec3 v_normal;
out vec4 v_colour;

void main() {
    v_place = a_place;
    v_normal = a_normal;
    v_colour = vec4(a_colour.rgb * a_colour.rgb, a_colour.a);
    gl_Position = u_matrix * vec4(a_place, 1.0);
}

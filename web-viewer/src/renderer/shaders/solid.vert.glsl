in vec3 a_position;
in vec3 a_normal;
in vec4 a_colour;    // sRGB

uniform mat4 u_matrix;
uniform vec3 u_from;    // m: u_matrix takes positions relative to this point
uniform vec4 u_turn;    // of an obstacle that moves: a quaternion of unit length, or zero, which does not turn
uniform vec3 u_move;    // m

out vec3 v_position;
out vec3 v_normal;
out vec4 v_colour;

vec3 turned(vec3 x) { return x + 2.0 * cross(u_turn.xyz, cross(u_turn.xyz, x) + u_turn.w * x); }

void main() {
    v_position = turned(a_position) + u_move;
    v_normal = turned(a_normal);
    v_colour = vec4(a_colour.rgb * a_colour.rgb, a_colour.a);
    gl_Position = u_matrix * vec4(v_position - u_from, 1.0);
}

// The edges of a face of the bounds. They are fainter while the face is turned to the eye, because it hides nothing.
in vec3 v_position;
in vec3 v_normal;    // out of the bounds
in vec4 v_colour;
layout(location = 0) out vec4 o_colour;

void main() {
    bool away = dot(v_normal, v_position - eye.xyz) > 0.0;
    o_colour = vec4(encode(v_colour.rgb), v_colour.a * (away ? 0.3 : 0.12));
}

in vec3 v_position;
in vec3 v_normal;
in vec4 v_colour;
layout(location = 0) out vec4 o_colour;

void main() { o_colour = vec4(encode(v_colour.rgb), v_colour.a); }

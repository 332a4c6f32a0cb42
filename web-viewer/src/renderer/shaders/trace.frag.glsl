in float v_strength;
layout(location = 0) out vec4 o_colour;

void main() { o_colour = vec4(0.94, 0.38, 0.12, v_strength); }

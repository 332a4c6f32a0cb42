in vec2 v_at;
layout(location = 0) out vec4 o_colour;

void main() {
    vec2 at = part.xy + v_at * part.zw;
    vec2 off = at - vec2(0.5, 0.55);
    vec3 colour = mix(backgroundBottom.rgb, backgroundTop.rgb, smoothstep(0.0, 1.0, at.y));
    o_colour = vec4(encode(colour * (1.0 - 0.16 * dot(off, off))), 1.0);
}

// The floor of the bounds with faint lines, and around it a floor that fades into the background.
in vec3 v_position;
in vec3 v_normal;
in vec4 v_colour;
layout(location = 0) out vec4 o_colour;

uniform vec2 u_half;      // m: half the bounds along x and y
uniform float u_ruler;    // m between lines
uniform float u_fade;     // m over which the surrounding floor fades

float ruled(vec2 at, float every) {
    vec2 width = max(fwidth(at), vec2(1e-6));
    vec2 off = abs(fract(at / every + 0.5) - 0.5) * every;
    vec2 line = (1.0 - smoothstep(vec2(0.0), width * 1.2, off)) * clamp(every / (8.0 * width), 0.0, 1.0);
    return max(line.x, line.y);
}

void main() {
    vec2 outward = max(abs(v_position.xy) - u_half, 0.0);
    float away = length(outward);
    float inside = away > 0.0 ? 0.0 : 1.0;
    float fade = 1.0 - smoothstep(0.0, u_fade, away);
    vec3 albedo = mix(surround.rgb, tile.rgb, inside);
    float share = lit(v_position, vec3(0.0, 0.0, 1.0), 0.0);
    vec3 ambient = sky.rgb;
    vec3 colour = albedo * (key.rgb * light.z * share + ambient);
    float line = inside * 0.10 * ruled(v_position.xy, u_ruler);
    colour = mix(colour, ink.rgb, line);
    o_colour = vec4(encode(colour), fade * fade);
}

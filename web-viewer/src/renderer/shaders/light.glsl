uniform highp sampler2DShadow u_shadow;
uniform float u_shadowTexel;

// Light is linear in the shaders, and stored as its square root, which is close to sRGB and much cheaper.
vec3 encode(vec3 linear) { return sqrt(clamp(linear, 0.0, 1.0)); }

// Share of the key light that reaches a position. The position is first moved by `lift` (m) along `normal`, off its
// own surface.
float lit(vec3 position, vec3 normal, float lift) {
    vec3 at = (shadow * vec4(position + normal * lift, 1.0)).xyz;
    if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
#ifdef SOFT_SHADOW
    float sum = 0.0;
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) sum += texture(u_shadow, at + vec3(vec2(x, y) * 1.4 * u_shadowTexel, 0.0));
    float share = sum / 9.0;
#else
    float share = texture(u_shadow, at);
#endif
    return mix(1.0, share, light.w);
}

// Key light, hemisphere ambient light, a soft highlight and a thin sheen at the rim. `share`: result of `lit`.
vec3 shade(vec3 albedo, vec3 normal, vec3 toEye, float share) {
    float facing = dot(normal, light.xyz);
    float direct = max(facing, 0.0) * share;
    vec3 ambient = mix(ground.rgb, sky.rgb, 0.5 + 0.5 * normal.z);
    vec3 halfway = normalize(light.xyz + toEye);
    float near = max(dot(normal, halfway), 0.0);
    near *= near;
    near *= near;
    near *= near;
    float highlight = near * near * near * near * 0.16 * direct;    // to the power of 32
    float rim = 1.0 - max(dot(normal, toEye), 0.0);
    return albedo * (key.rgb * direct + ambient) + key.rgb * highlight + sky.rgb * (0.10 * rim * rim * rim);
}

uniform sampler2DShadow u_shadow;

// Light is linear in the shaders, and stored as its square root, which is close to sRGB and much cheaper.
vec3 encode(vec3 linear) { return sqrt(clamp(linear, 0.0, 1.0)); }

// Compresses bright light to less than 1, so that highlights keep their hue.
vec3 compressed(vec3 linear) {
    vec3 bright = max(linear - 0.6, 0.0);
    return min(linear, 0.6) + 0.4 * bright / (bright + 0.4);
}

// Share of the key light that reaches a position. The position is first moved by `lift` (m) along `normal`, off its
// own surface.
float lit(vec3 position, vec3 normal, float lift) {
    vec3 at = (shadow * vec4(position + normal * lift, 1.0)).xyz;
    if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
#ifdef SOFT_SHADOW
    float sum = 0.0;
    float turn = 6.2831853 * noise();
    float texel = 1.0 / float(textureSize(u_shadow, 0).x);
    const int taps = 9;
    for (int i = 0; i < taps; i++) {
        float angle = turn + float(i) * 2.3999632;
        vec2 off = sqrt((float(i) + 0.5) / float(taps)) * vec2(cos(angle), sin(angle));
        sum += texture(u_shadow, at + vec3(2.2 * texel * off, 0.0));
    }
    float share = sum / float(taps);
#else
    float share = texture(u_shadow, at);
#endif
    return mix(1.0, share, light.w);
}

struct Surface {
    vec3 albedo;        // linear
    float roughness;    // 0..1
    float metal;        // 0..1
};

// The light of the surroundings from a direction: sky above, ground below, and a broad lamp on the side of the key
// light. `blur`: 0..1.
vec3 surroundings(vec3 direction, float blur) {
    float horizon = mix(0.12, 1.0, blur);
    vec3 colour = mix(ground.rgb, sky.rgb, smoothstep(-horizon, horizon, direction.z));
    vec3 lamp = normalize(light.xyz * vec3(-1.0, -1.0, 1.0));
    float near = max(dot(direction, lamp), 0.0);
    return colour + sky.rgb * (1.0 - blur) * smoothstep(0.82, 0.95, near);
}

// The key light by the law of Cook and Torrance (GGX distribution, visibility after Hammon 2017), and the light of the
// surroundings (integral of their reflection after Karis 2014). `share`: result of `lit`.
vec3 shade(Surface surface, vec3 normal, vec3 toEye, float share) {
    float alpha = max(surface.roughness * surface.roughness, 0.02);
    vec3 mirrored = mix(vec3(0.04), surface.albedo, surface.metal);    // reflection of vertical light
    vec3 diffuse = surface.albedo * (1.0 - surface.metal);
    float toLight = dot(normal, light.xyz);
    float facing = max(dot(normal, toEye), 1e-3);
    vec3 colour = vec3(0.0);
    if (toLight * share > 0.0) {
        vec3 halfway = normalize(light.xyz + toEye);
        float along = max(dot(normal, halfway), 0.0);
        float spread = along * along * (alpha * alpha - 1.0) + 1.0;
        float distribution = alpha * alpha / (spread * spread);    // times pi
        float visibility = 0.5 / mix(2.0 * toLight * facing, toLight + facing, alpha);
        float grazing = 1.0 - max(dot(toEye, halfway), 0.0);
        float grazing2 = grazing * grazing;
        vec3 fresnel = mirrored + (1.0 - mirrored) * (grazing2 * grazing2 * grazing);
        colour = key.rgb * (toLight * share) * (diffuse + min(distribution * visibility, 16.0) * fresnel);
    }
    vec4 r = surface.roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * facing)) * r.x + r.y;
    vec2 integral = vec2(-1.04, 1.04) * a + r.zw;
    vec3 ambient = mix(ground.rgb, sky.rgb, 0.5 + 0.5 * normal.z);
    vec3 reflected = surroundings(reflect(-toEye, normal), surface.roughness);
    return compressed(colour + diffuse * ambient + reflected * (mirrored * integral.x + integral.y));
}

flat in vec4 v_sphere;
flat in vec4 v_colour;
in vec3 v_ray;
out vec4 o_colour;

void main() {
    vec3 to = v_sphere.xyz;
    float radius = v_sphere.w;
    float a = dot(v_ray, v_ray);
    float b = dot(v_ray, to);
    float far2 = dot(to, to);
    float c = far2 - radius * radius;
    float square = b * b - a * c;
    float inside = radius - sqrt(max(far2 - b * b / a, 0.0));    // m from the outline
#ifdef COVERAGE
    float coverage = clamp(inside / (sqrt(far2) * eye.w) + 0.5, 0.0, 1.0);
    if (coverage <= 0.0) discard;
#else
    const float coverage = 1.0;
    if (inside < 0.0) discard;
#endif
    bool within = c < 0.0;    // the eye is in the sphere, and sees its inner side
    if (!within && b <= 0.0) discard;    // the sphere is behind the eye
    float root = sqrt(max(square, 0.0));
    float t = within ? (b + root) / a : c / (b + root);
    vec3 position = t * v_ray;
    vec3 normal = normalize(within ? to - position : position - to);

    vec4 clip = toClip * vec4(position, 1.0);
    if (within && clip.z < -clip.w) discard;    // nearer than all that is drawn
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
    position += eye.xyz;

    vec3 toEye = -normalize(v_ray);
    vec3 albedo = mix(v_colour.rgb, vec3(1.0), 0.35 * v_colour.w);
    float share = dot(normal, light.xyz) > 0.0 ? lit(position, normal, 0.05 * radius) : 0.0;
    vec3 colour = shade(albedo, normal, toEye, share);
    float rim = 1.0 - max(dot(normal, toEye), 0.0);
    colour = mix(colour, vec3(1.0, 0.98, 0.9), v_colour.w * smoothstep(0.55, 0.75, rim));
    o_colour = vec4(encode(colour), coverage);
}

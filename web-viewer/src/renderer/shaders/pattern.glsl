// The pattern that turns with a sphere: its octants are light and dark in turn.
uniform int u_turns;    // states that have orientations: none, the second one, or both

// The quaternion of an orientation of codec/orientations.ts.
vec4 quaternionOf(vec3 turn) {
    float square = dot(turn, turn);
    return vec4(2.0 * turn, 1.0 - square) / (1.0 + square);
}

// The factor of the albedo. `normal`: of the sphere; `size`: its radius (pixels); `facing`: of the surface, 0..1. The
// pattern is as sharp as the pixels allow, and fades on small spheres.
float patternNow(int place, vec3 normal, float size, float facing) {
    if (u_turns == 0 || size < 3.0) return 1.0;
    vec4 to = quaternionOf(turnTo(place));
    vec4 from = u_turns == 2 ? quaternionOf(turnFrom(place)) : to;
    vec4 turn = normalize(mix(dot(from, to) < 0.0 ? -from : from, to, u_mix));
    vec3 at = normal + 2.0 * cross(turn.xyz, cross(turn.xyz, normal) - turn.w * normal);
    vec3 side = clamp(at * size * max(facing, 0.1), -1.0, 1.0);
    return 1.0 - smoothstep(3.0, 10.0, size) * (0.22 + 0.22 * side.x * side.y * side.z);
}

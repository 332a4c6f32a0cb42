// Ambient occlusion from the depth buffer, after the "Alchemy" estimator of McGuire et al. 2011: the mean height of
// neighbours above the tangent plane, over their squared distance.
uniform sampler2D u_depth;
uniform mat4 u_unproject;    // inverse of the projection
uniform float u_reach;       // m
out vec4 o_share;

const int samples = 10;

// The position at the centre of a texel, where its depth is exact.
vec3 positionAt(ivec2 texel, ivec2 size) {
    texel = clamp(texel, ivec2(0), size - 1);
    vec2 at = (vec2(texel) + 0.5) / vec2(size);
    vec4 position = u_unproject * vec4(vec3(at, texelFetch(u_depth, texel, 0).r) * 2.0 - 1.0, 1.0);
    return position.xyz / position.w;
}

void main() {
    ivec2 size = textureSize(u_depth, 0);
    ivec2 here = clamp(ivec2(gl_FragCoord.xy) * 2, ivec2(1), size - 2);    // has neighbours on all sides
    if (texelFetch(u_depth, here, 0).r >= 1.0) {
        o_share = vec4(1.0);
        return;
    }
    vec3 position = positionAt(here, size);
    // The normal is taken from the nearer neighbour on each axis, so that it stays right at outlines.
    vec3 right = positionAt(here + ivec2(1, 0), size) - position;
    vec3 left = position - positionAt(here - ivec2(1, 0), size);
    vec3 above = positionAt(here + ivec2(0, 1), size) - position;
    vec3 below = position - positionAt(here - ivec2(0, 1), size);
    vec3 dx = abs(right.z) < abs(left.z) ? right : left;
    vec3 dy = abs(above.z) < abs(below.z) ? above : below;
    vec3 normal = normalize(cross(dx, dy));

    float span = min(u_reach / pixelAt(-position.z), 0.12 * float(size.y));    // texels
    float turn = 6.2831853 * noise();
    float hidden = 0.0;
    for (int i = 0; i < samples; i++) {
        float part = (float(i) + 0.5) / float(samples);
        float angle = turn + float(i) * 2.3999632;
        vec2 off = span * sqrt(part) * vec2(cos(angle), sin(angle));
        vec3 to = positionAt(here + ivec2(round(off)), size) - position;
        float distance2 = dot(to, to);
        float near = max(0.0, 1.0 - distance2 / (u_reach * u_reach));
        hidden += near * max(0.0, dot(to, normal) - 0.02 * u_reach) / (sqrt(distance2) + 0.02 * u_reach);
    }
    o_share = vec4(clamp(1.0 - 2.0 * hidden / float(samples), 0.0, 1.0), 0.0, 0.0, 1.0);
}

// Copies the shaded scene to the canvas. FULL: smooths the outlines of spheres by the share of the pixel that they
// cover, and other edges by their contrast. Darkens surfaces that lie behind another one at its edge, or in a hollow.
uniform sampler2D u_scene;
uniform float u_dim;     // 0..1: how stale the image is
uniform float u_haze;    // grey over a stale image
#ifdef FULL
uniform usampler2D u_code;
uniform sampler2D u_depth;
uniform sampler2D u_openness;
uniform float u_reach;    // m: a surface so far behind another one has the darkest outline
#endif
in vec2 v_at;
layout(location = 0) out vec4 o_colour;

#ifdef FULL
const ivec2 sides[4] = ivec2[](ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1));

// Ambient occlusion, smoothed over its 4 x 4 sampling pattern where depths are similar.
float openness(float here) {
    vec2 texel = 1.0 / vec2(textureSize(u_openness, 0));
    float sum = 0.0;
    float weights = 0.0;
    for (int y = 0; y < 4; y++) {
        for (int x = 0; x < 4; x++) {
            vec2 at = v_at + (vec2(x, y) - 1.5) * texel;
            float weight = exp(-abs(distanceOf(texture(u_depth, at).r) - here) * 120.0 / here) + 1e-4;
            sum += weight * texture(u_openness, at).r;
            weights += weight;
        }
    }
    return sum / weights;
}

// The share of this pixel that a sphere covers.
float coverageOf(uint code) {
    int place = placeOf(code);
    vec3 to = placeNow(place, axesOf(code));
    Meeting found = meet(rayAt(v_at), to, radiusOf(place));
    return found.visible ? clamp(found.outline / pixelAt(length(to)) + 0.5, 0.0, 1.0) : 0.0;
}

float brightness(vec3 colour) { return dot(colour, vec3(0.3, 0.59, 0.11)); }

// Smooths an edge of floor and obstacles along its direction, after FXAA (Lottes 2009).
vec3 smoothed(vec3 colour, vec3 beside[4]) {
    float here = brightness(colour);
    float right = brightness(beside[0]), left = brightness(beside[1]);
    float above = brightness(beside[2]), below = brightness(beside[3]);
    float low = min(here, min(min(right, left), min(above, below)));
    float high = max(here, max(max(right, left), max(above, below)));
    if (high - low < max(0.06, 0.12 * high)) return colour;
    vec2 across = vec2(right - left, above - below);
    vec2 along = normalize(vec2(-across.y, across.x) + 1e-6);
    vec2 texel = 0.75 * along / vec2(textureSize(u_scene, 0));
    return 0.25 * (2.0 * colour + texture(u_scene, v_at + texel).rgb + texture(u_scene, v_at - texel).rgb);
}

vec3 composed(ivec2 texel) {
    ivec2 last = textureSize(u_scene, 0) - 1;
    vec3 colour = texelFetch(u_scene, texel, 0).rgb;
    uint code = texelFetch(u_code, texel, 0).r;
    float depth = texelFetch(u_depth, texel, 0).r;
    float here = distanceOf(depth);
    vec3 beside[4];
    uint codes[4];
    float depths[4];
    uint nearest = code;
    float nearestDepth = depth;
    vec3 nearestColour = colour;
    bool edge = false;
    for (int k = 0; k < 4; k++) {
        ivec2 at = clamp(texel + sides[k], ivec2(0), last);
        beside[k] = texelFetch(u_scene, at, 0).rgb;
        codes[k] = texelFetch(u_code, at, 0).r;
        depths[k] = texelFetch(u_depth, at, 0).r;
        edge = edge || codes[k] != code;
        if (codes[k] == code || depths[k] >= nearestDepth) continue;
        nearest = codes[k];
        nearestDepth = depths[k];
        nearestColour = beside[k];
    }
    float behind = 0.0;    // 0..1, how far this surface is behind the nearest one beside it
    if (!edge) {
        if (code == 0u) colour = smoothed(colour, beside);
    } else if (nearest != code) {
        behind = clamp((here - distanceOf(nearestDepth)) / u_reach, 0.0, 1.0);
        if (nearest != 0u) colour = mix(colour, nearestColour, coverageOf(nearest));
    } else if (code != 0u) {
        float covered = coverageOf(code);
        if (covered < 1.0) {
            vec4 others = vec4(0.0);
            for (int k = 0; k < 4; k++) {
                if (codes[k] != code) others += vec4(beside[k], 1.0);
            }
            colour = mix(others.rgb / others.a, colour, covered);
        }
    }
    // Darkens towards a cool tint rather than to black.
    colour *= mix(vec3(0.30, 0.33, 0.40), vec3(1.0), depth < 1.0 ? openness(here) : 1.0);
    return colour * (1.0 - 0.4 * behind);
}
#else
vec3 composed(ivec2 texel) { return texelFetch(u_scene, texel, 0).rgb; }
#endif

void main() {
    vec3 colour = composed(ivec2(gl_FragCoord.xy));
    float grey = dot(colour, vec3(0.3, 0.59, 0.11));
    colour = mix(colour, mix(vec3(grey), vec3(u_haze), 0.25), 0.75 * u_dim);
    // Noise of less than one colour step avoids bands in the background.
    o_colour = vec4(colour + (noise() - 0.5) / 255.0, 1.0);
}

// Copies the scene to the canvas. Ambient occlusion is smoothed over its 4 x 4 sampling pattern where depths are
// similar. Noise of less than one colour step avoids bands in the background.
precision highp sampler2D;
uniform sampler2D u_scene;
uniform float u_dim;        // 0..1: how stale the image is
uniform float u_haze;       // grey over a stale image
#ifdef OCCLUSION
uniform sampler2D u_occlusion;
uniform sampler2D u_depth;
uniform vec2 u_planes;      // near, far
#endif
in vec2 v_at;
out vec4 o_colour;

#ifdef OCCLUSION
float distanceAt(vec2 at) {
    float depth = texture(u_depth, at).r;
    return u_planes.x * u_planes.y / (u_planes.y - depth * (u_planes.y - u_planes.x));
}

float openness() {
    vec2 texel = 1.0 / vec2(textureSize(u_occlusion, 0));
    float here = distanceAt(v_at);
    float sum = 0.0;
    float weights = 0.0;
    for (int y = 0; y < 4; y++) {
        for (int x = 0; x < 4; x++) {
            vec2 at = v_at + (vec2(x, y) - 1.5) * texel;
            float weight = exp(-abs(distanceAt(at) - here) * 120.0 / here) + 1e-4;
            sum += weight * texture(u_occlusion, at).r;
            weights += weight;
        }
    }
    return sum / weights;
}
#endif

void main() {
    vec3 colour = texture(u_scene, v_at).rgb;
#ifdef OCCLUSION
    // Darkens towards a cool tint rather than to black.
    colour *= mix(vec3(0.30, 0.33, 0.40), vec3(1.0), openness());
#endif
    float grey = dot(colour, vec3(0.3, 0.59, 0.11));
    colour = mix(colour, mix(vec3(grey), vec3(u_haze), 0.25), 0.75 * u_dim);
    float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    o_colour = vec4(colour + (noise - 0.5) / 255.0, 1.0);
}

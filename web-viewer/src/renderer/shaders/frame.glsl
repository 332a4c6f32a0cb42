// The uniforms that all passes share. frame_uniforms.ts fills them in this order. Positions on the device are relative
// to the centre of the bounds or to the eye, so that float32 suffices far from the origin.
layout(std140) uniform Frame {
    mat4 toClip;        // from positions relative to the eye to clip space; it does not translate
    mat4 fromClip;      // its inverse
    mat4 shadow;        // position to shadow map, all axes 0..1
    vec4 eye;           // m; w: height of a pixel (m) at a distance of 1 m, or at all distances if orthographic
    vec4 forward;       // direction of the view; w: 1 if orthographic, else 0
    vec4 planes;        // m: distances of the near and the far plane along the direction of the view
    vec4 kept;          // the points p relative to the eye with dot(kept.xyz, p) <= kept.w are shown
    vec4 part;          // of the whole picture: lower left corner and size, in shares
    vec4 light;         // direction to the light; w: strength of shadows, 0..1
    vec4 key;           // linear light, as all colours below
    vec4 sky;
    vec4 ground;
    vec4 backgroundTop;
    vec4 backgroundBottom;
    vec4 tile;          // floor inside the bounds
    vec4 surround;      // floor around the bounds
    vec4 ink;           // lines
};

// `to`: relative to the eye.
bool isCut(vec3 to) { return dot(kept.xyz, to) > kept.w; }

bool isOrthographic() { return forward.w > 0.5; }

// Height of a pixel (m) at a distance from the eye (m).
float pixelAt(float far) { return isOrthographic() ? eye.w : eye.w * far; }

// A ray of the image. Its origin is relative to the eye, and its direction has unit length.
struct Ray {
    vec3 origin;
    vec3 direction;
};

// The ray through a point (m, relative to the eye).
Ray rayTo(vec3 point) {
    if (isOrthographic()) return Ray(point - dot(point, forward.xyz) * forward.xyz, forward.xyz);
    return Ray(vec3(0.0), normalize(point));
}

// The point (m, relative to the eye) at a point of clip space, between the near and the far plane. In float32, the far
// plane of a large scene is at infinity.
vec3 pointAt(vec2 at) {
    vec4 point = fromClip * vec4(at, 0.0, 1.0);
    return point.xyz / point.w;
}

// The ray through a point of the image, 0..1 on both axes.
Ray rayAt(vec2 at) { return rayTo(pointAt(2.0 * at - 1.0)); }

// The depth, as the depth buffer holds it, of a point (m, relative to the eye).
float depthOf(vec3 point) {
    vec4 clip = toClip * vec4(point, 1.0);
    return 0.5 * clip.z / clip.w + 0.5;
}

// The distance (m) along the direction of the view of a depth.
float distanceOf(float depth) {
    if (isOrthographic()) return mix(planes.x, planes.y, depth);
    return planes.x * planes.y / (planes.y - depth * (planes.y - planes.x));
}

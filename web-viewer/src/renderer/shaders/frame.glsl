// The uniforms that all passes share. frame_uniforms.ts fills them in this order. Positions on the device are relative
// to the centre of the bounds, so that float32 suffices far from the origin.
layout(std140) uniform Frame {
    mat4 toClip;        // from positions relative to the eye to clip space; it does not translate
    mat4 fromClip;      // its inverse
    mat4 shadow;        // position to shadow map, all axes 0..1
    vec4 eye;           // m; w: height of a pixel at a distance of 1
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

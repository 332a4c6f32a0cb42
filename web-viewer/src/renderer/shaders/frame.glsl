// The uniforms that all passes share. frame_uniforms.ts fills them in this order.
layout(std140) uniform Frame {
    mat4 viewProjection;
    mat4 view;
    mat4 projection;
    mat4 shadow;        // world to shadow map, all axes 0..1
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

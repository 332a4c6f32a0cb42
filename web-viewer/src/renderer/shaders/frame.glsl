// What every pass of a picture shares; filled by frame.ts, in this order.
layout(std140) uniform Frame {
    mat4 viewProjection;
    mat4 view;
    mat4 projection;
    mat4 shadow;        // world to shadow map, all axes 0..1
    vec4 eye;           // m; w: tangent of half a pixel's angle, times two
    vec4 light;         // direction to the light; w: strength of its shadow, 0..1
    vec4 key;           // linear colours from here on
    vec4 sky;
    vec4 ground;
    vec4 backgroundTop;
    vec4 backgroundBottom;
    vec4 tile;          // floor inside the bounds
    vec4 surround;      // floor around them
    vec4 ink;           // lines
};

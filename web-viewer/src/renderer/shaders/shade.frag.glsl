// Shades each pixel once. The image of codes says which sphere a pixel shows. Floor and obstacles have their colour
// already. Writes the depth of the surfaces, because small spheres were drawn as discs.
uniform usampler2D u_code;
uniform sampler2D u_forward;    // colours of floor and obstacles
uniform sampler2D u_depth;      // of discs, floor and obstacles
uniform int u_selected;               // place; negative: none

in vec2 v_at;
layout(location = 0) out vec4 o_colour;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    uint code = texelFetch(u_code, texel, 0).r;
    if (code == 0u) {
        o_colour = texelFetch(u_forward, texel, 0);
        gl_FragDepth = texelFetch(u_depth, texel, 0).r;
        return;
    }
    int place = placeOf(code);
    float radius = radiusOf(place);
    vec3 to = placeNow(place, axesOf(code));
    Ray ray = rayAt(v_at);
    Meeting found = meet(ray, to, radius);
    vec3 near = ray.origin + found.along * ray.direction;
    gl_FragDepth = depthOf(near);
    vec3 position = eye.xyz + near;
    vec3 normal = found.open ? kept.xyz : (found.within ? -1.0 : 1.0) * normalize(near - to);
    vec3 toEye = -ray.direction;

    Look look = lookOf(place);
    float tint = 0.96 + 0.08 * float(scrambled(uint(place)) & 255u) / 255.0;
    vec3 albedo = colourNow(place, eye.xyz + to);
    albedo *= albedo * tint;
    float facing = dot(normal, toEye);
    if (!found.open && look.moves) albedo *= patternNow(place, normal, radius / pixelAt(length(near)), facing);
    bool selected = place == u_selected;
    if (selected) albedo = mix(albedo, vec3(1.0), 0.35);
    float share = dot(normal, light.xyz) > 0.0 ? lit(position, normal, 0.05 * radius) : 0.0;
    vec3 colour = shade(Surface(albedo, look.roughness, look.metal), normal, toEye, share);
    float rim = 1.0 - max(dot(normal, toEye), 0.0);
    // A light ring with a dark edge: one of the two differs from the colour behind the sphere.
    if (selected) {
        colour = mix(colour, vec3(1.0, 0.98, 0.9), smoothstep(0.42, 0.5, rim));
        colour = mix(colour, vec3(0.01, 0.015, 0.02), smoothstep(0.66, 0.72, rim));
    }
    o_colour = vec4(encode(colour), 1.0);
}

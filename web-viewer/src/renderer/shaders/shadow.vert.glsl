// Spheres are drawn as discs through their centres that face the light, so that no sphere shades its own lit side.
uniform usampler2D u_order;
uniform int u_first;
uniform vec3 u_image;
uniform uint u_imageBits;
uniform mat4 u_light;
uniform vec3 u_right;
uniform vec3 u_up;

out vec2 v_corner;

void main() {
    v_corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    int place = int(texelFetch(u_order, texelOf(u_first + gl_InstanceID), 0).r);
    float radius = radiusOf(place);
    vec3 to = placeNow(place, u_image);
    bool drawn = radius > 0.0 && isInside(to, radius) && !isCut(to);
    vec3 at = eye.xyz + to + radius * (v_corner.x * u_right + v_corner.y * u_up);
    gl_Position = drawn ? u_light * vec4(at, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}

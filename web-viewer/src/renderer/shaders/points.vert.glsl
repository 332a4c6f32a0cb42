// One point per sphere that is smaller than a pixel.
uniform usampler2D u_order;    // as in spheres.vert.glsl
uniform int u_first;
uniform vec3 u_image;
uniform uint u_imageBits;

flat out uint v_code;

void main() {
    int place = int(texelFetch(u_order, texelOf(u_first + gl_VertexID), 0).r);
    float radius = radiusOf(place);
    vec3 to = placeNow(place, u_image);
    v_code = codeOf(place, u_imageBits);
    gl_PointSize = 1.0;
    bool drawn = radius > 0.0 && isInside(to, radius) && !isCut(to);
    gl_Position = drawn ? toClip * vec4(to, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}

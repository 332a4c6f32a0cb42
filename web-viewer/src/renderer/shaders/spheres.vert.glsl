// One instance per sphere: a square that covers its outline as seen from the eye. Near a sphere and inside it, the
// square is the whole image.
//
// ROUND: the fragments have the depth of the surface. Else the square is a disc at the polar plane of the eye, which
// lies in the sphere; of bodies that do not overlap, it hides the right ones.
uniform usampler2D u_order;    // place of each sphere, in the order of drawing
uniform int u_first;                 // number of the first sphere of this call
uniform vec3 u_image;                // 1 for the axes across whose faces images are drawn, else 0
uniform uint u_imageBits;

flat out uint v_code;
#ifdef ROUND
flat out vec4 v_sphere;    // centre relative to the eye; radius
out vec3 v_at;             // a point of the ray, relative to the eye
#else
out vec2 v_corner;         // 1: the outline
#endif

void main() {
    int place = int(texelFetch(u_order, texelOf(u_first + gl_InstanceID), 0).r);
    float radius = radiusOf(place);
    vec3 to = placeNow(place, u_image);
    v_code = codeOf(place, u_imageBits);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
#ifdef ROUND
    v_sphere = vec4(to, radius);
    v_at = vec3(0.0);
#else
    v_corner = vec2(0.0);
#endif
    if (radius <= 0.0 || !isInside(to, radius)) return;
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    float far = length(to);
#ifdef ROUND
    if (!isOrthographic() && far <= radius * 1.05) {
        v_at = pointAt(corner);
        gl_Position = vec4(corner, 0.0, 1.0);
        return;
    }
#endif
    vec3 axis = isOrthographic() ? forward.xyz : to / far;
    vec3 right = normalize(abs(axis.z) < 0.99 ? cross(axis, vec3(0.0, 0.0, 1.0)) : cross(axis, vec3(0.0, 1.0, 0.0)));
    vec3 up = cross(right, axis);
    float tangent2 = isOrthographic() ? 1.0 : max(far * far - radius * radius, 1e-12 * far * far);
    float outline = isOrthographic() ? radius : radius * far * inversesqrt(tangent2);
    float drawn = outline + 0.5 * pixelAt(far);
    vec3 at = to + drawn * (corner.x * right + corner.y * up);
#ifdef ROUND
    v_at = at;
#else
    v_corner = corner * (drawn / outline);
    if (!isOrthographic()) at *= tangent2 / (far * far);
#endif
    gl_Position = toClip * vec4(at, 1.0);
}

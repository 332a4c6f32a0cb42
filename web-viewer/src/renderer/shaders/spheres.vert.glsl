// One instance per sphere: a square through its centre that covers its outline as seen from the eye. Near a sphere and
// inside it, the square is the whole image.
uniform int u_selected;

flat out vec4 v_sphere;    // centre relative to the eye; radius
flat out vec4 v_colour;    // linear; w: 1 if selected
out vec3 v_ray;            // from the eye to the square, or into its direction

void main() {
    vec3 centre = centreNow();
    float radius = a_radius;
    vec3 to = centre - eye.xyz;
    float far = length(to);
    v_sphere = vec4(to, radius);
    v_colour = vec4(0.0);
    v_ray = vec3(0.0);
    if (!isDrawn()) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        return;
    }
    vec3 colour = colourNow(centre);
    float tint = 0.94 + 0.12 * float(scrambled(uint(gl_InstanceID)) & 255u) / 255.0;
    v_colour = vec4(colour * colour * tint, gl_InstanceID == u_selected ? 1.0 : 0.0);
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    if (far <= radius * 1.05) {
        vec4 there = fromClip * vec4(corner, 1.0, 1.0);
        v_ray = there.xyz / there.w;
        gl_Position = vec4(corner, 0.0, 1.0);
        return;
    }
    vec3 axis = to / far;
    vec3 right = normalize(abs(axis.z) < 0.99 ? cross(axis, vec3(0.0, 0.0, 1.0)) : cross(axis, vec3(0.0, 1.0, 0.0)));
    vec3 up = cross(right, axis);
    float outline = radius * far / sqrt(far * far - radius * radius) + far * eye.w;
    v_ray = to + outline * (corner.x * right + corner.y * up);
    gl_Position = toClip * vec4(v_ray, 1.0);
}

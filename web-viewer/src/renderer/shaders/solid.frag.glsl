in vec3 v_position;
in vec3 v_normal;
in vec4 v_colour;
uniform float u_opacity;    // factor
uniform vec3 u_ends;        // m: the largest coordinates that are drawn, on either side; 0: all are drawn

layout(location = 0) out vec4 o_colour;

void main() {
    vec3 to = v_position - eye.xyz;
    if (isCut(to)) discard;
    if (u_ends.x > 0.0 && any(greaterThan(abs(v_position), u_ends))) discard;
    vec3 toEye = -rayTo(to).direction;
    vec3 normal = normalize(v_normal);
    float lift = 2.0 * pixelAt(length(to));
    float share = dot(normal, light.xyz) > 0.0 ? lit(v_position, normal, lift) : 0.0;
    o_colour = vec4(encode(shade(Surface(v_colour.rgb, 0.6, 0.0), normal, toEye, share)), v_colour.a * u_opacity);
}

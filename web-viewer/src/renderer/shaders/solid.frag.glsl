in vec3 v_position;
in vec3 v_normal;
in vec4 v_colour;
out vec4 o_colour;

void main() {
    vec3 toEye = normalize(eye.xyz - v_position);
    vec3 normal = normalize(v_normal);
    float share = dot(normal, light.xyz) > 0.0 ? lit(v_position, normal, 0.002 * length(eye.xyz - v_position)) : 0.0;
    o_colour = vec4(encode(shade(v_colour.rgb, normal, toEye, share)), v_colour.a);
}

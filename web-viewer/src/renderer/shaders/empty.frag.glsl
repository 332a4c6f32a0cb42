in vec3 v_position;
uniform vec3 u_ends;    // see solid.frag.glsl

void main() {
    if (isCut(v_position - eye.xyz)) discard;
    if (u_ends.x > 0.0 && any(greaterThan(abs(v_position), u_ends))) discard;
}

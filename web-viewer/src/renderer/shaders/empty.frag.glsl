in vec3 v_position;

void main() {
    if (isCut(v_position - eye.xyz)) discard;
}

in vec3 v_position;

void main() {
    if (isCut(v_position)) discard;
}

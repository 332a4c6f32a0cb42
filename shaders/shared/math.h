// Written out, because compilers may contract or reorder the built-in ones differently on each device.
float dot3(vec3 a, vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

bool finite3(vec3 a) {
    // NaN and infinity both fail x - x == 0.
    vec3 d = a - a;
    return d.x == 0.0f && d.y == 0.0f && d.z == 0.0f;
}

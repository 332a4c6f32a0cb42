flat in uint v_code;
#ifdef ROUND
flat in vec4 v_sphere;
in vec3 v_at;
#else
in vec2 v_corner;
#endif
layout(location = 1) out uint o_code;

void main() {
#ifdef ROUND
    Ray ray = rayTo(v_at);
    Meeting found = meet(ray, v_sphere.xyz, v_sphere.w);
    if (found.outline < 0.0 || !found.visible) discard;
    float depth = depthOf(ray.origin + found.along * ray.direction);
    if (found.within && depth < 0.0) discard;    // nearer than all that is drawn
    gl_FragDepth = depth;
#else
    if (dot(v_corner, v_corner) > 1.0) discard;
#endif
    o_code = v_code;
}

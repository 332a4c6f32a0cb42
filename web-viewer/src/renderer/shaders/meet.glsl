// Where a ray meets a sphere. The distance between the ray and the centre comes from the difference of two points. The
// difference of two squares would lose most digits of small spheres far away: see Haines and others, "Precision
// improvements for ray/sphere intersection", 2019.
struct Meeting {
    float outline;    // m from the outline of the sphere: positive inside
    float along;      // m along the ray to the surface; to the nearest point of the sphere if the ray misses it
    bool visible;     // the surface is before the eye, and in the shown half of space
    bool within;      // the eye is in the sphere, and sees its inner side
    bool open;        // the ray meets the plane that cuts the sphere
};

Meeting meet(Ray ray, vec3 centre, float radius) {
    vec3 to = centre - ray.origin;
    float middle = dot(to, ray.direction);
    vec3 off = to - middle * ray.direction;
    float off2 = dot(off, off);
    float depth = sqrt(max(0.0, radius * radius - off2));
    bool within = !isOrthographic() && dot(to, to) < radius * radius;
    bool visible = isOrthographic() || within || middle > 0.0;
    float along = within ? middle + depth : middle - depth;
    bool open = false;
    float steep = dot(kept.xyz, ray.direction);
    float ahead = kept.w - dot(kept.xyz, ray.origin);    // m; negative: the origin is cut off
    if (steep < 0.0 && ahead < 0.0) {
        float begin = ahead / steep;
        open = begin > middle - depth;
        within = within && !open;
        along = open ? begin : along;
        visible = visible && begin <= middle + depth;
    } else if (steep > 0.0) {
        visible = visible && along * steep <= ahead;
    } else {
        visible = visible && ahead >= 0.0;
    }
    return Meeting(radius - sqrt(off2), along, visible, within, open);
}

// The contact response of all baselines, for the pairs that their broad phases find. Removes half of the overlap,
// bounces approaching pairs, then applies gravity, motion and walls. A sphere only reads the state before the substep
// (Jacobi), so one kernel suffices. Radii and masses are equal. This file uses buffer slots 0 to 4.

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(writeonly, vec4, newPosition)
BUFFER(writeonly, vec4, newVelocity)
BUFFER(coherent, uint, tally)

PRIVATE(uint, self)
PRIVATE(vec3, here)
PRIVATE(vec3, speed)
PRIVATE(vec3, push)
PRIVATE(vec3, kick)
PRIVATE(uint, touching)

void begin(uint sphere) {
    self = sphere;
    here = vec3(position[sphere]);
    speed = vec3(velocity[sphere]);
    push = vec3(0.0f);
    kick = vec3(0.0f);
    touching = 0u;
}

void meet(uint other) {
    vec3 d = here - vec3(position[other]);
    float squared = dot3(d, d);
    float reach = 2.0f * params.radius;
    if (!(squared < reach * reach) || other == self) return;
    touching = touching + 1u;
    vec4 contact = normalAndDistance(d, squared, self, other);
    vec3 normal = vec3(contact);
    push = push + normal * (0.5f * (reach - contact.w));
    float approach = dot3(speed - vec3(velocity[other]), normal);
    if (approach < 0.0f) kick = kick - normal * (0.5f * (1.0f + params.contact.x) * approach);
}

// Keeps the coordinate x between two walls; returns the new coordinate and the new speed.
vec2 bounce(float x, float v, float low, float high, uint face) {
    if ((params.closedFaces & (1u << face)) != 0u && x < low)
        return vec2(low, v < 0.0f ? -params.contact.x * v : v);
    if ((params.closedFaces & (2u << face)) != 0u && x > high)
        return vec2(high, v > 0.0f ? -params.contact.x * v : v);
    return vec2(x, v);
}

void finish() {
    vec3 v = speed + kick + vec3(params.gravity) * params.substep;
    vec3 x = here + push + v * params.substep;
    vec3 low = vec3(params.wallMin) + vec3(params.radius);
    vec3 high = vec3(params.wallMax) - vec3(params.radius);
    vec2 alongX = bounce(x.x, v.x, low.x, high.x, 0u);
    vec2 alongY = bounce(x.y, v.y, low.y, high.y, 2u);
    vec2 alongZ = bounce(x.z, v.z, low.z, high.z, 4u);
    newPosition[self] = vec4(alongX.x, alongY.x, alongZ.x, position[self].w);
    newVelocity[self] = vec4(alongX.y, alongY.y, alongZ.y, velocity[self].w);
    if (HAS(COUNT)) atomicAdd(tally[TALLY_CONTACTS], touching);
}

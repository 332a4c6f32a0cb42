// What contacts change of the velocities in this substep: behind the velocities and, with friction, the spins. The includer
// binds `velocity`.

uint kickOf(uint sphere) {
    return (HAS(FRICTION) ? 2u : 1u) * params.spheres + sphere;
}

void addKick(uint sphere, vec3 change) {
    vec4 sum = velocity[kickOf(sphere)];
    velocity[kickOf(sphere)] = vec4(vec3(sum) + change, 0.0f);
}

void addTwist(uint sphere, vec3 change) {
    uint at = params.spheres + kickOf(sphere);
    velocity[at] = vec4(vec3(velocity[at]) + change, 0.0f);
}

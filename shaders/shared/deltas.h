// Adds up the changes of velocity and angular velocity by the contacts of this substep. apply_forces.comp applies them.
// The includer binds `deltaVelocity` and, with friction, `deltaOmega`.

void addDeltaVelocity(uint sphere, vec3 change) {
    deltaVelocity[sphere] = vec4(vec3(deltaVelocity[sphere]) + change, 0.0f);
}

void addDeltaOmega(uint sphere, vec3 change) {
    deltaOmega[sphere] = vec4(vec3(deltaOmega[sphere]) + change, 0.0f);
}

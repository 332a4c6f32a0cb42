// The contact parameters of two spheres, or of a sphere and a wall. The includer binds `idAndMaterial` and
// `contactParams`.

uint contactIndex(uint a, uint b) {
    return materialOf(idAndMaterial[a]) * params.materials + materialOf(idAndMaterial[b]);
}

vec4 contactOf(uint a, uint b) {
    return HAS(MATERIALS) ? contactParams[contactIndex(a, b)].contact : params.contact;
}

vec4 stiffnessOf(uint a, uint b) {
    return HAS(MATERIALS) ? contactParams[contactIndex(a, b)].stiffness : params.stiffness;
}

// The row of contactParams for a sphere and the material of a wall.
uint wallContactIndex(uint sphere, uint wallMaterial) {
    uint material = HAS(MATERIALS) ? materialOf(idAndMaterial[sphere]) : params.material;
    return material * params.materials + wallMaterial;
}

// The contact parameters of two spheres. The includer binds `idAndMaterial` and `contactParams`.

uint contactIndex(uint a, uint b) {
    return materialOf(idAndMaterial[a]) * params.materials + materialOf(idAndMaterial[b]);
}

vec4 contactOf(uint a, uint b) {
    return HAS(MATERIALS) ? contactParams[contactIndex(a, b)].contact : params.contact;
}

vec4 stiffnessOf(uint a, uint b) {
    return HAS(MATERIALS) ? contactParams[contactIndex(a, b)].stiffness : params.stiffness;
}

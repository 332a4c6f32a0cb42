// What holds between two spheres. The includer binds `idAndMaterial` and `contactParams`.

uint lawIndex(uint a, uint b) {
    return materialOf(idAndMaterial[a]) * params.materials + materialOf(idAndMaterial[b]);
}

vec4 contactLaw(uint a, uint b) {
    return HAS(MATERIALS) ? contactParams[lawIndex(a, b)].contact : params.law;
}

vec4 stiffnessLaw(uint a, uint b) {
    return HAS(MATERIALS) ? contactParams[lawIndex(a, b)].stiffness : params.stiffness;
}

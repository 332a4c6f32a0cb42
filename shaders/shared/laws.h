// What holds between two spheres. The includer binds `label` and `laws`.

uint lawIndex(uint a, uint b) {
    return materialOf(label[a]) * params.materials + materialOf(label[b]);
}

vec4 contactLaw(uint a, uint b) {
    return HAS(MATERIALS) ? laws[lawIndex(a, b)].contact : params.law;
}

vec4 stiffnessLaw(uint a, uint b) {
    return HAS(MATERIALS) ? laws[lawIndex(a, b)].stiffness : params.stiffness;
}

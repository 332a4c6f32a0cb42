// What two spheres remember of their contact is kept, while the lists are rebuilt, with the smaller of them, which has few
// neighbours of its own size or above; with the lower id where both are equal. The includer binds `position` and `idAndMaterial`.
bool firstKeepsSlip(uint a, uint b) {
    if (HAS(RADII)) {
        float ra = position[a].w;
        float rb = position[b].w;
        if (ra != rb) return ra < rb;
    }
    return idOf(idAndMaterial[a]) < idOf(idAndMaterial[b]);
}

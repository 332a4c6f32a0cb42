// Returns true if a owns what the contact of a and b remembers while the lists are rebuilt. The owner is the smaller
// sphere, which has few neighbours of its own size or above. If radii are equal, it is the sphere with the lower id.
// The includer binds `position` and `idAndMaterial`.
bool firstOwnsContact(uint a, uint b) {
    if (HAS(RADII)) {
        float ra = storedRadius(position[a]);
        float rb = storedRadius(position[b]);
        if (ra != rb) return ra < rb;
    }
    return idOf(idAndMaterial[a]) < idOf(idAndMaterial[b]);
}

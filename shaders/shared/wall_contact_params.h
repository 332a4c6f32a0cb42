// The contact parameters of the sphere `wallSphere` (a PRIVATE variable of the includer: its slot) and a wall's
// material. The includer binds `idAndMaterial` and `contactParams`.

uint wallContactIndex(uint wallMaterial) {
    uint mine = HAS(MATERIALS) ? materialOf(idAndMaterial[wallSphere]) : params.material;
    return mine * params.materials + wallMaterial;
}

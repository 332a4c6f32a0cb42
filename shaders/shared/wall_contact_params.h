// What holds between sphere `wallSphere` (a PRIVATE slot of the includer's) and a wall's material. The includer binds
// `idAndMaterial` and `contactParams`.

uint wallContactIndex(uint wallMaterial) {
    uint mine = HAS(MATERIALS) ? materialOf(idAndMaterial[wallSphere]) : params.material;
    return mine * params.materials + wallMaterial;
}

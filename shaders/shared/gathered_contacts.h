// Contacts of a sphere with a mesh in the model `accurate`. On a curved surface a sphere touches two triangles that are
// nearly in one plane. Two springs would be twice as stiff as one, so contacts whose normals differ little act as one: the
// deepest. Its force is the gradient of an energy. A mean of the normals would give spheres energy at each edge.
// The includer has defined visitSurface(), and has included shared/moving.h.
#define MOST_GATHERED 8u

PRIVATE(uint, gathered)
PRIVATE(vec3, gatheredFirst[MOST_GATHERED])    // normal of the first contact
PRIVATE(vec4, gatheredDeepest[MOST_GATHERED])  // normal and depth (m) of the deepest contact
PRIVATE(uint, gatheredKey[MOST_GATHERED])      // of the smooth part

void gather(vec4 surface, Obstacle mesh, uint key) {
    float overlap = sphereRadius - surface.w;
    if (!(overlap > -TOUCHES * sphereRadius)) return;
    vec3 normal = vec3(surface);
    for (uint k = 0u; k < gathered; ++k) {
        if (gatheredKey[k] != key || dot3(gatheredFirst[k], normal) < SMOOTH_COSINE) continue;
        if (overlap > gatheredDeepest[k].w) gatheredDeepest[k] = vec4(normal, overlap);
        return;
    }
    if (gathered == MOST_GATHERED) return;
    gatheredFirst[gathered] = normal;
    gatheredDeepest[gathered] = vec4(normal, overlap);
    gatheredKey[gathered] = key;
    gathered = gathered + 1u;
}

void visitGathered(Obstacle mesh) {
    for (uint k = 0u; k < gathered; ++k) {
        uint direction = 0u;
        for (uint before = 0u; before < k; ++before)
            if (gatheredKey[before] == gatheredKey[k]) direction = min(direction + 1u, KEYS_PER_GROUP - 1u);
        vec3 normal = vec3(gatheredDeepest[k]);
        float overlapOfDeepest = gatheredDeepest[k].w;
        if (isMoving(mesh))
            setSurfaceMotion(obstacles[mesh.motion], spherePoint - normal * (sphereRadius - overlapOfDeepest), normal);
        visitSurface(true, normal, -overlapOfDeepest, 0.0f, mesh.material, mesh.surface, gatheredKey[k] + direction);
    }
    if (isMoving(mesh)) setSurfaceAtRest();
    gathered = 0u;
}

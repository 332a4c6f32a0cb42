// Contacts of a sphere with a mesh in the model `accurate`. On a curved surface a sphere touches two triangles that are
// nearly in one plane. Two springs would be twice as stiff as one, so contacts whose normals differ little act as one.
// Its depth is the largest, and its normal the mean of the normals by depth. The includer has defined visitSurface(), and
// has included shared/moving.h.
#define MOST_GATHERED 8u
#define SMOOTH_COSINE 0.9659f  // of 15 degrees: between two faces that are joined by an edge of less than 10
#define KEYS_PER_GROUP 4u      // of contacts with one smooth part of a mesh, in different directions

PRIVATE(uint, gathered)
PRIVATE(vec4, gatheredFirst[MOST_GATHERED])  // normal of the first contact; w: 1 if there are more
PRIVATE(vec4, gatheredSum[MOST_GATHERED])    // sum of depth times normal; w: largest depth (m)
PRIVATE(uint, gatheredKey[MOST_GATHERED])    // of the smooth part

void gather(vec4 surface, Obstacle mesh, uint key) {
    float overlap = sphereRadius - surface.w;
    if (!(overlap > -TOUCHES * sphereRadius)) return;
    vec3 normal = vec3(surface);
    float weight = max(overlap, sphereRadius * 1.0e-9f);
    for (uint k = 0u; k < gathered; ++k) {
        if (gatheredKey[k] != key || dot3(vec3(gatheredFirst[k]), normal) < SMOOTH_COSINE) continue;
        gatheredFirst[k] = vec4(vec3(gatheredFirst[k]), 1.0f);
        gatheredSum[k] = vec4(vec3(gatheredSum[k]) + normal * weight, max(gatheredSum[k].w, overlap));
        return;
    }
    if (gathered == MOST_GATHERED) return;
    gatheredFirst[gathered] = vec4(normal, 0.0f);
    gatheredSum[gathered] = vec4(normal * weight, overlap);
    gatheredKey[gathered] = key;
    gathered = gathered + 1u;
}

void visitGathered(Obstacle mesh) {
    for (uint k = 0u; k < gathered; ++k) {
        uint direction = 0u;
        for (uint before = 0u; before < k; ++before)
            if (gatheredKey[before] == gatheredKey[k]) direction = min(direction + 1u, KEYS_PER_GROUP - 1u);
        vec3 normal = vec3(gatheredFirst[k]);
        if (gatheredFirst[k].w != 0.0f) {
            vec3 sum = vec3(gatheredSum[k]);
            normal = sum * (1.0f / sqrt(dot3(sum, sum)));
        }
        if (isMoving(mesh))
            setSurfaceMotion(obstacles[mesh.motion], spherePoint - normal * (sphereRadius - gatheredSum[k].w), normal);
        visitSurface(true, normal, -gatheredSum[k].w, 0.0f, mesh.material, mesh.surface, gatheredKey[k] + direction);
    }
    if (isMoving(mesh)) setSurfaceAtRest();
    gathered = 0u;
}

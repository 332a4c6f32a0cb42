// How far a mesh is at least. The includer binds `obstacleLists`, and has included shared/shapes.h.
#include "shared/mesh_layout.h"

// Returns a distance (m) that is no larger than the one from the point to the mesh; 0 near the mesh.
float roomAtMesh(Obstacle mesh, vec3 point) {
    vec3 p = intoFrame(mesh, point);
    float outX = max(max(mesh.a.x - p.x, p.x - mesh.a.x - mesh.b.x / mesh.a.w), 0.0f);
    float outY = max(max(mesh.a.y - p.y, p.y - mesh.a.y - mesh.b.y / mesh.a.w), 0.0f);
    float outZ = max(max(mesh.a.z - p.z, p.z - mesh.a.z - mesh.b.z / mesh.a.w), 0.0f);
    float squared = outX * outX + outY * outY + outZ * outZ;
    if (!(squared < FAR_AWAY)) return FAR_AWAY;  // or not finite
    // From a point outside of the grid, the way to the mesh leads through the nearest cell, and turns there by at least a
    // right angle.
    float x = min(max(floor((p.x - mesh.a.x) * mesh.a.w), 0.0f), mesh.b.x - 1.0f);
    float y = min(max(floor((p.y - mesh.a.y) * mesh.a.w), 0.0f), mesh.b.y - 1.0f);
    float z = min(max(floor((p.z - mesh.a.z) * mesh.a.w), 0.0f), mesh.b.z - 1.0f);
    uint cell = obstacleLists[mesh.cellsAt + uint(x + mesh.b.x * (y + mesh.b.y * z))];
    float inside = cell >= EMPTY_CELL ? uintBitsToFloat(cell & 0x7fffffffu) : 0.0f;
    if (!(squared > 0.0f)) return inside;
    return max(sqrt(squared + inside * inside), sqrt(squared) + mesh.b.w);
}

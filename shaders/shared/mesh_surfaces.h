// The parts of a mesh that spheres may touch. Each place is nearest to one face, edge or vertex: a face if it is above or
// below the triangle, an edge if it lies in the wedge beyond the edge, a vertex if it lies in the cone beyond it. Faces
// are tested by <=, edges and vertices by > on the same numbers, so a sphere that moves is never in none of them.
// Triangles in one plane are one patch, and their inner edges are left out, so a sphere rolls over them without a bump.
//
// After: LAMMPS (granular surfaces), Jolt (InternalEdgeRemovingCollector), Baerentzen and Aanaes, "Signed distance
// computation using the angle weighted pseudonormal", 2005.
//
// shared/surfaces.h includes it, and defines visitPart(). The includer of that defines, before,
//   `void gather(real4 surface, Obstacle mesh, uint key)`: takes a contact in the model `accurate`;
//   `void visitGathered(Obstacle mesh)`: visits them when all contacts with the mesh are known.
// shared/gathered_contacts.h has them, and shared/no_gathered_contacts.h for kernels of the other models.

PRIVATE(real3, meshPoint)        // the centre of the sphere in the frame of the mesh when the visit began (m)
PRIVATE(real3, meshVelocity)     // of the sphere relative to the mesh (m/s); 0 without look ahead
PRIVATE(real, meshReach)         // how far from the centre the sphere may touch (m)
PRIVATE(uints, lastPatch)        // keys of the last two patches that the sphere met
PRIVATE(uints, patchBefore)
PRIVATE(real, nearestOutside)    // m: the nearest feature on whose free side the centre is
PRIVATE(real, nearestInside)     // m, negative: the nearest face on whose solid side the centre is
PRIVATE(uints, wayOut)           // its triangle, or END_OF_LIST

float meshReal(uint at) {
    return uintBitsToFloat(obstacleLists[at]);
}

vec3 meshVector(uint at) {
    return vec3(meshReal(at), meshReal(at + 1u), meshReal(at + 2u));
}

// Visits the feature that is in `featurePlace` and `featureAlong`.
void visitFeature(mask where, Obstacle mesh, uint part, uint key) {
    real4 surface = surfaceAt(mesh, part, spherePoint);
    if (HAS(ACCURATE))
        gather(surface, mesh, key);
    else
        visitPart(where, mesh, part, surface, part >= MESH_EDGE, mesh.surface, key);
}

void usePlane(uint triangle) {
    featurePlace = vec4(meshVector(triangle + TRIANGLE_NORMAL), meshReal(triangle + TRIANGLE_NORMAL + 3u));
}

// `above`: the height of the centre over the plane (m).
void visitFace(mask within, Obstacle mesh, uint triangle, real above) {
    uint key = obstacleLists[triangle + TRIANGLE_KEY];
    mask met = lastPatch == key || patchBefore == key;
    mask where = within && !met;
    if (!anyLane(where)) return;
    usePlane(triangle);
    if (obstacleLists[triangle + TRIANGLE_CLOSED] != 0u) {
        mask inside = where && above < 0.0f;
        mask nearer = inside && above > nearestInside;
        nearestInside = select(nearer, above, nearestInside);
        wayOut = select(nearer, uints(triangle), wayOut);
        where = where && !inside;
        nearestOutside = select(where, min(nearestOutside, above), nearestOutside);
        if (anyLane(where)) visitFeature(where, mesh, MESH_FRONT, key);
    } else {
        // The sphere touches the side on which its centre was at the start of the substep. `fast` has moved it since.
        real start = above;
        if (HAS(FAST)) {
            real3 normal = real3(surfaceAt(mesh, MESH_FRONT, spherePoint));
            start = above - dot3(meshVelocity, normal) * params.substep;
        }
        mask front = where && start >= 0.0f;
        if (anyLane(front)) visitFeature(front, mesh, MESH_FRONT, key);
        mask back = where && !front;
        if (anyLane(back)) visitFeature(back, mesh, MESH_BACK, key);
    }
    patchBefore = select(where, lastPatch, patchBefore);
    lastPatch = select(where, uints(key), lastPatch);
}

void visitEdge(mask where, Obstacle mesh, uint edge, real3 d, real along) {
    featurePlace = vec4(meshVector(edge + EDGE_FROM), 0.0f);
    featureAlong = vec4(meshVector(edge + EDGE_ALONG), 0.0f);
    real3 across = d - real3(meshVector(edge + EDGE_ALONG)) * along;
    real distance = sqrt(dot3(across, across));
    nearestOutside = select(where, min(nearestOutside, distance), nearestOutside);
    mask meets = where && distance <= meshReach;
    if (anyLane(meets)) visitFeature(meets, mesh, MESH_EDGE, obstacleLists[edge + EDGE_KEY]);
}

void visitVertex(mask where, Obstacle mesh, uint vertex) {
    real3 d = meshPoint - real3(meshVector(vertex + VERTEX_PLACE));
    real distance = sqrt(dot3(d, d));
    vec3 normal = meshVector(vertex + VERTEX_NORMAL);
    bool solid = normal.x != 0.0f || normal.y != 0.0f || normal.z != 0.0f;
    mask meets = where && distance <= meshReach;
    if (solid) meets = meets && dot3(d, real3(normal)) > 0.0f;
    uint end = vertex + VERTEX_EDGES + obstacleLists[vertex + VERTEX_COUNT];
    for (uint k = vertex + VERTEX_EDGES; k < end && anyLane(meets); ++k) {
        uint edge = obstacleLists[k] / 2u;
        real along = dot3(meshPoint - real3(meshVector(edge + EDGE_FROM)), real3(meshVector(edge + EDGE_ALONG)));
        if (obstacleLists[k] % 2u == 0u)
            meets = meets && along <= 0.0f;
        else
            meets = meets && along >= meshReal(edge + EDGE_LENGTH);
    }
    if (!anyLane(meets)) return;
    nearestOutside = select(meets, min(nearestOutside, distance), nearestOutside);
    featurePlace = vec4(meshVector(vertex + VERTEX_PLACE), 0.0f);
    visitFeature(meets, mesh, MESH_VERTEX, obstacleLists[vertex + VERTEX_KEY]);
}

void visitTriangle(mask where, Obstacle mesh, uint triangle) {
    real height = dot3(meshPoint, real3(meshVector(triangle + TRIANGLE_NORMAL)));
    precise real above = height - meshReal(triangle + TRIANGLE_NORMAL + 3u);
    bool closed = obstacleLists[triangle + TRIANGLE_CLOSED] != 0u;
    mask close = where && above <= meshReach;
    if (closed)
        close = close && above >= -mesh.b.w;
    else
        close = close && -above <= meshReach;
    if (!anyLane(close)) return;
    mask within = close;
    for (uint k = 0u; k < 3u; ++k) {
        uint word = obstacleLists[triangle + TRIANGLE_EDGES + k];
        uint edge = word / 2u;
        uint side = word % 2u;
        real3 d = meshPoint - real3(meshVector(edge + EDGE_FROM));
        real outward = dot3(d, real3(meshVector(edge + EDGE_AWAY + 3u * side)));
        mask beyond = close && outward > 0.0f;
        within = within && !beyond;
        uint flags = obstacleLists[edge + EDGE_FLAGS];
        if (side != 0u || (flags & EDGE_MEETS) == 0u || !anyLane(beyond)) continue;
        if ((flags & EDGE_SHARED) != 0u) beyond = beyond && dot3(d, real3(meshVector(edge + EDGE_AWAY + 3u))) > 0.0f;
        real along = dot3(d, real3(meshVector(edge + EDGE_ALONG)));
        beyond = beyond && along > 0.0f && along < meshReal(edge + EDGE_LENGTH);
        if (anyLane(beyond)) visitEdge(beyond, mesh, edge, d, along);
    }
    if (anyLane(within)) visitFace(within, mesh, triangle, above);
    mask outside = close && !within;
    if (!anyLane(outside)) return;
    for (uint k = 0u; k < 3u; ++k) {
        uint vertex = obstacleLists[triangle + TRIANGLE_VERTICES + k];
        if (vertex != 0u) visitVertex(outside, mesh, vertex);
    }
}

// Returns the lists of the cells in which the centres are; the empty list for others.
uints trianglesNear(mask where, Obstacle mesh) {
    real x = floor((meshPoint.x - mesh.a.x) * mesh.a.w);
    real y = floor((meshPoint.y - mesh.a.y) * mesh.a.w);
    real z = floor((meshPoint.z - mesh.a.z) * mesh.a.w);
    mask covered = where && x >= 0.0f && y >= 0.0f && z >= 0.0f && x < mesh.b.x && y < mesh.b.y && z < mesh.b.z;
    uints cell = wholeOf(select(covered, x + (y + z * mesh.b.y) * mesh.b.x, real(0.0f)));
    uints list = ROW(obstacleLists, cell + mesh.cellsAt);
    return select(covered && (list >> 31u) == 0u, list, uints(NO_OBSTACLES));
}

void visitMesh(mask where, Obstacle mesh) {
    meshPoint = intoFrame(mesh, spherePoint);
    meshVelocity = velocityAlong();
    if (isMoving(mesh) && looksAhead()) meshVelocity = relativeTo(mesh, real(0.0f), spherePoint, meshVelocity);
    meshReach = sphereRadius * (1.0f + TOUCHES) + sqrt(dot3(meshVelocity, meshVelocity)) * params.substep;
    lastPatch = uints(END_OF_LIST);
    patchBefore = uints(END_OF_LIST);
    wayOut = uints(END_OF_LIST);
    nearestOutside = real(FAR_AWAY);
    nearestInside = real(-FAR_AWAY);
    uints place = trianglesNear(where, mesh);
    uints number = ROW(obstacleLists, place);
    for (uint least = leastOf(number); least != END_OF_LIST; least = leastOf(number)) {
        mask here = number == least;
        visitTriangle(here, mesh, mesh.trianglesAt + least * TRIANGLE_WORDS);
        place = select(here, place + 1u, place);
        number = ROW(obstacleLists, place);
    }
    // A centre in the solid leaves it through the nearest face.
    mask inside = -nearestInside < nearestOutside;
    for (uint least = leastOf(wayOut); least != END_OF_LIST; least = leastOf(wayOut)) {
        mask here = wayOut == least;
        mask leaves = here && inside;
        wayOut = select(here, uints(END_OF_LIST), wayOut);
        if (!anyLane(leaves)) continue;
        usePlane(least);
        visitFeature(leaves, mesh, MESH_FRONT, obstacleLists[least + TRIANGLE_KEY]);
    }
    if (HAS(ACCURATE)) visitGathered(mesh);
}

// The parts of a mesh that spheres may touch. Each place is nearest to one face, edge or vertex. Above or below a
// triangle, the face is nearest. An edge is nearest in the wedge beyond it, and a vertex in the cone beyond it. Faces
// are tested by <=, edges and vertices by > on the same numbers, so a sphere that moves is never in none of them.
// Triangles in one plane are one patch, and their inner edges are left out, so a sphere rolls over them without a bump.
//
// After: LAMMPS (granular surfaces), Jolt (InternalEdgeRemovingCollector), Baerentzen and Aanaes, "Signed distance
// computation using the angle weighted pseudonormal", 2005.
//
// shared/surfaces.h includes it, and defines visitPart(). The includer of that defines, before,
//   `void gather(real4 surface, Obstacle mesh, uint key)`: takes a contact in the model `accurate`;
//   `void visitGathered(Obstacle mesh)`: visits them when all contacts with the mesh are known.
// shared/gathered_contacts.h has them. In kernels of the other models they are empty.

// In the model `accurate`, a spring must not end while it is compressed. The centre of a sphere that is pressed deep
// into one side of a groove is above that side alone. The other side goes on in its plane, below the first one.
#define GROOVE_LENGTH 0.75f  // radii from the edge, across it
#define GROOVE_SPREAD 0.25f  // of that, beyond the ends of the edge

#include "shared/mesh_tree.h"

PRIVATE(real3, meshStart)      // the centre of the sphere in the frame of the mesh at the start of the substep (m)
PRIVATE(real3, meshVelocity)   // of the sphere relative to the mesh (m/s); 0 without look ahead
PRIVATE(uints, lastPatch)      // keys of the last two patches that the sphere met
PRIVATE(uints, patchBefore)
PRIVATE(real, nearestOutside)  // m: the nearest feature on whose free side the centre is
PRIVATE(real, nearestInside)   // m, negative: the nearest face on whose solid side the centre is
PRIVATE(uints, wayOut)         // address of its triangle, or END_OF_LIST
PRIVATE(mask, faceFront)       // lanes that meet the front of the present triangle
PRIVATE(mask, faceBack)
PRIVATE(mask, closeLanes)      // lanes near the present triangle
PRIVATE(mask, besideLanes)     // lanes near it that are beside it, neither above nor below
PRIVATE(uint, featureKey)
PRIVATE(mask, pendingLanes)    // lanes with a face that they have met and not yet visited
PRIVATE(real4, pendingSurface)
PRIVATE(uints, pendingKey)

// Visits the faces that lanes have met and not yet visited.
void visitPending(Obstacle mesh) {
    if (!anyLane(pendingLanes)) return;
    visitSurface(pendingLanes, real3(pendingSurface), pendingSurface.w - sphereRadius, real(0.0f), mesh.material,
                 mesh.surface, pendingKey);
    pendingLanes = noLane();
}

// Visits the feature that is in `featurePlace` and `featureAlong`. Faces at rest wait until the sphere meets its next
// feature, so that lanes visit theirs together.
RARE void visitFeature(mask where, Obstacle mesh, uint part) {
    if (LANES > 1u && anyLane(where && pendingLanes)) visitPending(mesh);
    real4 surface = surfaceAt(mesh, part, spherePoint);
    if (HAS(ACCURATE)) {
        gather(surface, mesh, featureKey);
    } else if (LANES > 1u && part < MESH_EDGE && !isMoving(mesh)) {
        pendingLanes = pendingLanes || where;
        pendingSurface = select(where, surface, pendingSurface);
        pendingKey = select(where, uints(featureKey), pendingKey);
    } else {
        visitPart(where, mesh, part, surface, part >= MESH_EDGE, mesh.surface, featureKey);
    }
}

// Finds which side of a triangle the spheres meet that are above or below it. `above`: the height of the centre (m).
void findSides(mask within, uint triangle, real above) {
    uint key = obstacleLists[triangle + TRIANGLE_KEY];
    mask where = within;
    if (!HAS(ACCURATE)) where = where && !(lastPatch == key || patchBefore == key);  // gather() compares all faces
    if ((obstacleLists[triangle + TRIANGLE_FLAGS] & TRIANGLE_CLOSED) != 0u) {
        mask inside = where && above < 0.0f;
        mask nearer = inside && above > nearestInside;
        nearestInside = select(nearer, above, nearestInside);
        wayOut = select(nearer, uints(triangle), wayOut);
        where = where && !inside;
        nearestOutside = select(where, min(nearestOutside, above), nearestOutside);
        faceFront = where;
    } else {
        // The sphere touches the side on which its centre was at the start of the substep.
        real start = above;
        if (HAS(FAST))
            start = dot3(meshStart, real3(meshVector(triangle + TRIANGLE_NORMAL))) -
                    meshReal(triangle + TRIANGLE_NORMAL + 3u);
        faceFront = where && start >= 0.0f;
        faceBack = where && !faceFront;
    }
    patchBefore = select(where, lastPatch, patchBefore);
    lastPatch = select(where, uints(key), lastPatch);
}

// Finds the spheres that are near a triangle, and those that are above or below it.
void findNear(mask where, uint triangle) {
    real height = dot3(meshPoint, real3(meshVector(triangle + TRIANGLE_NORMAL)));
    precise real above = height - meshReal(triangle + TRIANGLE_NORMAL + 3u);
    closeLanes = where && abs(above) <= meshReach;
    besideLanes = noLane();
    if (!anyLane(closeLanes)) return;
    mask inGroove = noLane();
    mask inGrooveBehind = noLane();
    // Only near an edge or beyond it, the place is compared with the edge itself.
    mask inside = closeLanes;
    for (uint k = 0u; k < 3u; ++k)
        inside = inside && heightAbove(triangle + TRIANGLE_SIDES + 4u * k, meshPoint) < -meshMargin;
    bool allInside = !anyLane(closeLanes && !inside);
    for (uint k = 0u; k < 3u && !allInside; ++k) {
        uint word = obstacleLists[triangle + TRIANGLE_EDGES + k];
        uint edge = word / 2u;
        real3 d = meshPoint - real3(meshVector(edge + EDGE_FROM));
        real beyond = dot3(d, real3(meshVector(edge + EDGE_AWAY + 3u * (word % 2u))));
        mask outside = closeLanes && beyond > 0.0f;
        besideLanes = besideLanes || outside;
        uint flags = obstacleLists[edge + EDGE_FLAGS];
        if (!HAS(ACCURATE) || (flags & (EDGE_GROOVE | EDGE_GROOVE_BEHIND)) == 0u || !anyLane(outside)) continue;
        // The plane goes on below the other triangle.
        real alongEdge = dot3(d, real3(meshVector(edge + EDGE_ALONG)));
        real spread = beyond * GROOVE_SPREAD;
        mask continued = outside && beyond < sphereRadius * GROOVE_LENGTH && alongEdge > -spread &&
                         alongEdge < spread + meshReal(edge + EDGE_LENGTH);
        if ((flags & EDGE_GROOVE) != 0u) inGroove = inGroove || continued;
        if ((flags & EDGE_GROOVE_BEHIND) != 0u) inGrooveBehind = inGrooveBehind || continued;
    }
    mask within = closeLanes && !besideLanes;
    if (anyLane(within)) findSides(within, triangle, above);
    if (HAS(ACCURATE)) {
        faceFront = faceFront || (inGroove && above > 0.0f);
        faceBack = faceBack || (inGrooveBehind && above < 0.0f);
    }
}

// Returns the spheres that may touch an edge of a triangle, if it is the first triangle of the edge.
mask atEdge(uint triangle, uint k) {
    if (!anyLane(besideLanes)) return noLane();
    uint word = obstacleLists[triangle + TRIANGLE_EDGES + k];
    uint edge = word / 2u;
    uint flags = obstacleLists[edge + EDGE_FLAGS];
    if (word % 2u != 0u || (flags & EDGE_MEETS) == 0u) return noLane();
    vec3 direction = meshVector(edge + EDGE_ALONG);
    real3 d = meshPoint - real3(meshVector(edge + EDGE_FROM));
    real along = dot3(d, real3(direction));
    mask where = besideLanes && dot3(d, real3(meshVector(edge + EDGE_AWAY))) > 0.0f && along > 0.0f &&
                 along < meshReal(edge + EDGE_LENGTH);
    if ((flags & EDGE_SHARED) != 0u) where = where && dot3(d, real3(meshVector(edge + EDGE_AWAY + 3u))) > 0.0f;
    real3 across = d - real3(direction) * along;
    real distance = sqrt(dot3(across, across));
    nearestOutside = select(where, min(nearestOutside, distance), nearestOutside);
    featurePlace = vec4(meshVector(edge + EDGE_FROM), 0.0f);
    featureAlong = vec4(direction, 0.0f);
    featureKey = obstacleLists[edge + EDGE_KEY];
    return where && distance <= meshReach;
}

// Returns the spheres beyond the first end of an edge, or beyond its `second`.
mask beyondEnd(uint edge, bool second) {
    real along = dot3(meshPoint - real3(meshVector(edge + EDGE_FROM)), real3(meshVector(edge + EDGE_ALONG)));
    if (second) return along >= meshReal(edge + EDGE_LENGTH);
    return along <= 0.0f;
}

// Returns the spheres that may touch a vertex of a triangle, if the vertex belongs to the triangle.
mask atVertex(uint triangle, uint k) {
    if (!anyLane(besideLanes)) return noLane();
    uint vertex = obstacleLists[triangle + TRIANGLE_VERTICES + k];
    if (vertex == 0u) return noLane();
    // First, by the edges of the triangle, because they have just been read.
    uint before = k == 0u ? 2u : k - 1u;
    uint flags = obstacleLists[triangle + TRIANGLE_FLAGS];
    mask where = besideLanes &&
                 beyondEnd(obstacleLists[triangle + TRIANGLE_EDGES + k] / 2u, (flags & (TRIANGLE_TURNED << k)) != 0u) &&
                 beyondEnd(obstacleLists[triangle + TRIANGLE_EDGES + before] / 2u,
                           (flags & (TRIANGLE_TURNED << before)) == 0u);
    if (!anyLane(where)) return noLane();
    real3 d = meshPoint - real3(meshVector(vertex + VERTEX_PLACE));
    real distance = sqrt(dot3(d, d));
    vec3 normal = meshVector(vertex + VERTEX_NORMAL);
    where = where && distance <= meshReach;
    if (normal.x != 0.0f || normal.y != 0.0f || normal.z != 0.0f) where = where && dot3(d, real3(normal)) > 0.0f;
    uint end = vertex + VERTEX_EDGES + obstacleLists[vertex + VERTEX_COUNT];
    for (uint at = vertex + VERTEX_EDGES; at < end && anyLane(where); ++at)
        where = where && beyondEnd(obstacleLists[at] / 2u, obstacleLists[at] % 2u != 0u);
    nearestOutside = select(where, min(nearestOutside, distance), nearestOutside);
    featurePlace = vec4(meshVector(vertex + VERTEX_PLACE), 0.0f);
    featureKey = obstacleLists[vertex + VERTEX_KEY];
    return where;
}

mask atFace(uint triangle, mask where) {
    featurePlace = vec4(meshVector(triangle + TRIANGLE_NORMAL), meshReal(triangle + TRIANGLE_NORMAL + 3u));
    featureKey = obstacleLists[triangle + TRIANGLE_KEY];
    return where;
}

// `leaves`: the centres are in the solid, and the way out leads through the front of the triangle. (The features are in
// one loop, because compilers would copy visitFeature() to each of its calls.)
void visitTriangle(mask where, Obstacle mesh, uint triangle, bool leaves) {
    faceFront = where;
    faceBack = noLane();
    besideLanes = noLane();
    if (!leaves) {
        faceFront = noLane();
        findNear(where, triangle);
        if (!anyLane(closeLanes)) return;
    }
    for (uint feature = 0u; feature < 8u; ++feature) {
        mask meets = noLane();
        uint part = MESH_FRONT;
        if (feature < 3u) {
            meets = atEdge(triangle, feature);
            part = MESH_EDGE;
        } else if (feature < 5u) {
            meets = atFace(triangle, feature == 3u ? faceFront : faceBack);
            part = feature == 3u ? MESH_FRONT : MESH_BACK;
        } else {
            meets = atVertex(triangle, feature - 5u);
            part = MESH_VERTEX;
        }
        if (anyLane(meets)) visitFeature(meets, mesh, part);
    }
}

void visitMesh(mask where, Obstacle mesh) {
    meshPoint = intoFrame(mesh, spherePoint);
    meshVelocity = velocityAlong();
    if (isMoving(mesh) && looksAhead()) meshVelocity = relativeTo(mesh, real(0.0f), spherePoint, meshVelocity);
    meshStart = meshPoint;
    if (HAS(FAST)) meshStart = intoFrame(mesh, spherePoint - meshVelocity * real(params.substep));
    meshReach = sphereRadius * (1.0f + TOUCHES) + sqrt(dot3(meshVelocity, meshVelocity)) * params.substep;
    if (HAS(ACCURATE))
        meshReach = sphereRadius * sqrt(1.0f + GROOVE_LENGTH * GROOVE_LENGTH * (1.0f + GROOVE_SPREAD * GROOVE_SPREAD));
    meshMargin = meshReal(mesh.nodesAt - 1u);
    lastPatch = uints(END_OF_LIST);
    patchBefore = uints(END_OF_LIST);
    wayOut = uints(END_OF_LIST);
    pendingLanes = noLane();
    pendingSurface = real4(0.0f, 0.0f, 0.0f, 0.0f);
    pendingKey = uints(0u);
    nearestOutside = real(FAR_AWAY);
    nearestInside = real(-FAR_AWAY);
    beginToLook(where, mesh);
    bool leaves = false;
    while (true) {
        look(mesh);
        uint triangle = leastOf(nearTriangle);
        if (triangle == END_OF_LIST) {
            if (leaves) break;
            // At the end, centres in the solid leave it through the nearest face.
            leaves = true;
            nearTriangle = select(-nearestInside < nearestOutside, wayOut, uints(END_OF_LIST));
            continue;
        }
        mask here = nearTriangle == triangle;
        visitTriangle(here, mesh, triangle, leaves);
        if (leaves) {
            nearTriangle = select(here, uints(END_OF_LIST), nearTriangle);
        } else {
            EACH_LANE_NUMBER(here, takeNext, 0u)
        }
    }
    if (LANES > 1u) visitPending(mesh);
    if (HAS(ACCURATE)) visitGathered(mesh);
}

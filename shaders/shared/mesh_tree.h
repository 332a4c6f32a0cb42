// The triangles of a mesh that a sphere may reach, found by its tree (shared/mesh_layout.h). Each lane has its own way
// through the tree: where triangles are small, spheres beside each other share few of them.
//
// shared/mesh_surfaces.h includes it. It sets the first three variables, then calls beginToLook() and look(). It visits
// nearTriangle of each lane, and calls takeNext() and look(), until all are END_OF_LIST.

// A sphere looks for this many triangles before it visits them.
#define MOST_FOUND (LANES > 1u ? 8u : 1u)

// The tests that come before the exact ones reach this many times as far, because numbers are rounded.
#define REACH_MORE 1.001f

PRIVATE(real3, meshPoint)      // the centre of the sphere in the frame of the mesh when the visit began (m)
PRIVATE(real, meshReach)       // the sphere may touch what is within this distance of its centre (m)
PRIVATE(float, meshMargin)     // larger than errors of places (m)
PRIVATE(uints, looking)        // 1 while the sphere looks for triangles
PRIVATE(uints, nodePlace)      // where the number of the next node is, or END_OF_LIST
PRIVATE(uints, listsBehind)    // 1 if another list follows the present one
PRIVATE(uints, leavesAt)       // address of the first leaf of the present group
PRIVATE(uints, leavesLeft)     // bit k: the sphere looks at leaf k of the group later
PRIVATE(uints, trianglesAt)    // the same for the triangles of the present leaf
PRIVATE(uints, trianglesLeft)
PRIVATE(uints, nearTriangles[MOST_FOUND])  // addresses of triangles that the sphere may reach
PRIVATE(uints, trianglesFound)             // their number
PRIVATE(uints, trianglesTaken)             // how many of them the sphere has visited, or visits next
PRIVATE(uints, nearTriangle)   // address of the triangle that the sphere visits next, or END_OF_LIST

float meshReal(uint at) {
    return uintBitsToFloat(obstacleLists[at]);
}

vec3 meshVector(uint at) {
    return vec3(meshReal(at), meshReal(at + 1u), meshReal(at + 2u));
}

// Returns the height above a plane (m). `plane`: the address of its normal and offset.
ANY_REAL heightAbove(uint plane, ANY_REAL3 point) {
    return point.x * meshReal(plane) + point.y * meshReal(plane + 1u) + point.z * meshReal(plane + 2u) -
           meshReal(plane + 3u);
}

// Returns the children of a node that a sphere may reach, and some that it does not: bit k for child k.
uint childrenNear(uint node, vec3 point, float reach) {
    vec3 normal = meshVector(node + NODE_NORMAL);
    vec3 across = meshVector(node + NODE_ACROSS);
    vec3 d = point - meshVector(node + NODE_CENTRE);
    float height = dot3(d, normal);
    float gap = max(max(meshReal(node + NODE_LOW) - height, height - meshReal(node + NODE_HIGH)), 0.0f);
    if (!(gap < reach)) return 0u;
    float steps = meshReal(node + NODE_STEPS);
    float room = sqrt((reach - gap) * (reach + gap)) * REACH_MORE * steps;
    float u = dot3(d, across) * steps + STEPS_TO_CENTRE;
    float v = dot3(d, cross3(normal, across)) * steps + STEPS_TO_CENTRE;
    if (abs(u - STEPS_TO_CENTRE) > STEPS_TO_CENTRE + room || abs(v - STEPS_TO_CENTRE) > STEPS_TO_CENTRE + room)
        return 0u;
    uint lowU = uint(clamp(u - room, 0.0f, ALL_STEPS)) * FOUR_BYTES;
    uint lowV = uint(clamp(v - room, 0.0f, ALL_STEPS)) * FOUR_BYTES;
    uint highU = uint(clamp(u + room, 0.0f, ALL_STEPS)) * FOUR_BYTES | TOP_BITS;
    uint highV = uint(clamp(v + room, 0.0f, ALL_STEPS)) * FOUR_BYTES | TOP_BITS;
    // The top bit of a difference stays if the first byte, less its own top bit, is not less than the second one.
    uint near = 0u;
    uint count = obstacleLists[node + NODE_COUNT];
    for (uint k = 0u; k < count; k += 4u) {
        uint at = node + NODE_BOXES + k;
        uint meets = (highU - obstacleLists[at]) & (obstacleLists[at + 1u] - lowU) & (highV - obstacleLists[at + 2u]) &
                     (obstacleLists[at + 3u] - lowV) & TOP_BITS;
        near = near | ((((meets >> 7u) * 0x204081u) >> 21u) & 15u) << k;  // gathers the four bits
    }
    return near & ((1u << count) - 1u);
}

// Prefetches what lookFurther() reads first.
void expectList(uint lane, uint unused) {
    PREFETCH(obstacleLists[LANE_OF(nodePlace, lane)])
}
void expectNodes(uint lane, Obstacle mesh) {
    for (uint place = LANE_OF(nodePlace, lane); obstacleLists[place] != END_OF_LIST; ++place) {
        PREFETCH(obstacleLists[mesh.nodesAt + obstacleLists[place] * NODE_WORDS])
        PREFETCH(obstacleLists[mesh.nodesAt + obstacleLists[place] * NODE_WORDS + LINE_WORDS])
    }
}

// Prefetches children of a node, which all have two lines.
void expectChildren(uint first, uint children) {
    for (uint more = children; more != 0u; more &= more - 1u) {
        PREFETCH(obstacleLists[first + uint(findLSB(more)) * NODE_WORDS])
        PREFETCH(obstacleLists[first + uint(findLSB(more)) * NODE_WORDS + LINE_WORDS])
    }
}

// Adds triangles of the present leaf to those that the sphere of a lane visits.
void findTriangles(uint lane, vec3 point, float reach) {
    uint first = LANE_OF(trianglesAt, lane);
    uint left = LANE_OF(trianglesLeft, lane);
    uint found = LANE_OF(trianglesFound, lane);
    while (left != 0u && found < MOST_FOUND) {
        uint triangle = first + uint(findLSB(left)) * TRIANGLE_WORDS;
        left = left & (left - 1u);
        float above = heightAbove(triangle + TRIANGLE_NORMAL, point);
        float gap = max(abs(above) - meshMargin, 0.0f);
        if (!(gap < reach)) continue;
        float beside = max(max(heightAbove(triangle + TRIANGLE_SIDES, point),
                               heightAbove(triangle + TRIANGLE_SIDES + 4u, point)),
                           heightAbove(triangle + TRIANGLE_SIDES + 8u, point));
        if (!(beside < sqrt((reach - gap) * (reach + gap)) + meshMargin)) continue;
        if (beside > meshMargin) {
            float wedge = meshReal(triangle + TRIANGLE_WEDGE);
            if (wedge != ANY_WEDGE && beside > wedge * (above + meshMargin) + meshMargin) continue;
        }
        LANE_OF(nearTriangles[found], lane) = triangle;
        found = found + 1u;
        if (beside < -meshMargin) continue;  // findNear() reads no edge
        for (uint k = 0u; k < 3u; ++k) {
            PREFETCH(obstacleLists[obstacleLists[triangle + TRIANGLE_EDGES + k] / 2u])
        }
    }
    LANE_OF(trianglesLeft, lane) = left;
    LANE_OF(trianglesFound, lane) = found;
}

// One step of the way through the tree. Lanes take turns, so that a step finds in the cache what the step before has
// prefetched.
void lookFurther(uint lane, Obstacle mesh) {
    vec3 point = LANE_OF(meshPoint, lane);
    float reach = LANE_OF(meshReach, lane) * REACH_MORE;
    uint leaves = LANE_OF(leavesLeft, lane);
    uint node = LANE_OF(leavesAt, lane) + uint(findLSB(leaves)) * NODE_WORDS;
    if (LANE_OF(trianglesLeft, lane) != 0u) {
        findTriangles(lane, point, reach);
    } else {
        if (leaves == 0u) {
            uint place = LANE_OF(nodePlace, lane);
            uint number = obstacleLists[place];
            if (number == END_OF_LIST && LANE_OF(listsBehind, lane) != 0u) {
                LANE_OF(listsBehind, lane) = 0u;
                place = place + 1u;
                number = obstacleLists[place];
            }
            LANE_OF(nodePlace, lane) = number == END_OF_LIST ? END_OF_LIST : place + 1u;
            node = mesh.nodesAt + number * NODE_WORDS;
        }
        if (LANE_OF(nodePlace, lane) != END_OF_LIST) {
            uint near = childrenNear(node, point, reach);
            uint child = obstacleLists[node + NODE_FIRST];
            if (LANES > 1u) expectChildren(child, near);
            if (obstacleLists[node + NODE_IS_GROUP] != 0u) {
                LANE_OF(leavesAt, lane) = child;
                LANE_OF(leavesLeft, lane) = near;
            } else {
                LANE_OF(leavesLeft, lane) = leaves & (leaves - 1u);
                LANE_OF(trianglesAt, lane) = child;
                LANE_OF(trianglesLeft, lane) = near;
            }
        }
    }
    uint found = LANE_OF(trianglesFound, lane);
    if (LANE_OF(nodePlace, lane) != END_OF_LIST && found < MOST_FOUND) return;
    LANE_OF(looking, lane) = 0u;
    if (found == 0u) return;
    LANE_OF(nearTriangle, lane) = LANE_OF(nearTriangles[0], lane);
    LANE_OF(trianglesTaken, lane) = 1u;
}

// Sets the next triangle that the sphere of a lane visits, or lets it look for more.
void takeNext(uint lane, uint unused) {
    uint taken = LANE_OF(trianglesTaken, lane);
    if (taken < LANE_OF(trianglesFound, lane)) {
        LANE_OF(nearTriangle, lane) = LANE_OF(nearTriangles[taken], lane);
        LANE_OF(trianglesTaken, lane) = taken + 1u;
        return;
    }
    LANE_OF(nearTriangle, lane) = END_OF_LIST;
    LANE_OF(trianglesFound, lane) = 0u;
    LANE_OF(looking, lane) = LANE_OF(nodePlace, lane) == END_OF_LIST ? 0u : 1u;
}

// Returns the lists near the cells in which the centres are; the empty list for others.
uints nodesNear(mask where, Obstacle mesh) {
    real x = floor((meshPoint.x - mesh.a.x) * mesh.a.w);
    real y = floor((meshPoint.y - mesh.a.y) * mesh.a.w);
    real z = floor((meshPoint.z - mesh.a.z) * mesh.a.w);
    mask covered = where && x >= 0.0f && y >= 0.0f && z >= 0.0f && x < mesh.b.x && y < mesh.b.y && z < mesh.b.z;
    uints cell = wholeOf(select(covered, x + (y + z * mesh.b.y) * mesh.b.x, real(0.0f)));
    uints list = ROW(obstacleLists, cell + mesh.cellsAt);
    return select(covered && (list >> 31u) == 0u, list, uints(NO_OBSTACLES));
}

// Begins the way of the lanes in `where`.
void beginToLook(mask where, Obstacle mesh) {
    nodePlace = nodesNear(where, mesh);
    mask listed = nodePlace != NO_OBSTACLES;
    looking = select(listed, uints(1u), uints(0u));
    listsBehind = select(listed && meshReach > NEAR_SHARE * mesh.b.w, uints(1u), uints(0u));
    leavesAt = uints(0u);
    leavesLeft = uints(0u);
    trianglesAt = uints(0u);
    trianglesLeft = uints(0u);
    trianglesFound = uints(0u);
    nearTriangle = uints(END_OF_LIST);
    if (LANES == 1u) return;
    EACH_LANE_NUMBER(listed, expectList, 0u)
    EACH_LANE_NUMBER(listed, expectNodes, mesh)
}

// Sets nearTriangle of the lanes that look for triangles.
void look(Obstacle mesh) {
    while (anyLane(looking != 0u)) {
        EACH_LANE_NUMBER(looking != 0u, lookFurther, mesh)
    }
}

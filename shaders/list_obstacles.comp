// Lists the obstacles near each sphere. A list holds as long as the sphere stays closer to its list reference than its
// room, the distance to the nearest obstacle that it leaves out. The list is in the order of the obstacles. If there is
// no space for it, the sphere has the list of all obstacles.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/shapes.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, Obstacle, obstacles)
BUFFER(restrict, uint, obstacleLists)    // see layout.h
BUFFER(writeonly, uvec2, nearObstacles)  // place of the list, bits of the room (m)
BUFFER(coherent, uint, counters)
BUFFER(readonly, uint, moverSlots)

#include "shared/mesh_room.h"
#include "shared/movers.h"
#include "shared/grid.h"
#include "shared/mover_reach.h"

// The lists hold for some time even if all spheres fall together, and the pair lists with them.
#define LIST_REACH 2.0f  // in margins

// The distance from a mesh is a lower limit.
float distanceTo(uint number, vec3 point) {
    Obstacle obstacle = obstacles[number];
    if (HAS(MESHES) && obstacle.shape == MESH_SHAPE) return roomAtMesh(obstacle, point);
    float nearest = surfaceAt(obstacle, 0u, point).w;
    for (uint part = 1u; part < obstacle.parts; ++part) nearest = min(nearest, surfaceAt(obstacle, part, point).w);
    return nearest;
}

KERNEL(params.spheres) {
    if (invocation >= builtSpheres()) return;
    uint slot = moversAlone() ? moverSlots[invocation] : invocation;
    vec3 point = vec3(position[slot]);
    vec3 v = vec3(velocity[slot]);
    float radius = radiusOf(position[slot]);
    // A contact that ended in the last substep is listed too, because the sphere must forget it.
    float reach = radius + LIST_REACH * params.margin + sqrt(dot3(v, v)) * params.substep;
    if (moversAlone()) reach = reach + moreMotion(radius, velocity[slot]);
    if (HAS(MOTION)) reach = reach + OBSTACLE_SUBSTEPS * params.obstaclePath;
    float room = 1.0e18f;
    uint found = 0u;
    for (uint k = 0u; k < params.obstacles; ++k) {
        float distance = distanceTo(k, point);
        if (distance < reach)
            found = found + 1u;
        else
            room = min(room, distance - radius);
    }
    uint place = NO_OBSTACLES;
    if (found > 0u) {
        place = ALL_OBSTACLES + params.obstacles + 1u + params.meshWords + atomicAdd(counters[COUNTER_NEAR_OBSTACLES], found + 1u);
        if (place + found < params.obstacleListWords) {
            uint at = place;
            for (uint k = 0u; k < params.obstacles; ++k) {
                if (!(distanceTo(k, point) < reach)) continue;
                obstacleLists[at] = k;
                at = at + 1u;
            }
            obstacleLists[at] = END_OF_LIST;
        } else {
            place = ALL_OBSTACLES;
        }
    }
    nearObstacles[slot] = uvec2(place, floatBitsToUint(room));
}

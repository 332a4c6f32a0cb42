// Moves the spheres that have left the bounds through a periodic axis back by whole lengths, and counts these for each
// sphere, so that its path can be followed. Scenes with contacts do so when the lists are rebuilt, others in each
// substep.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"
#include "shared/wrap.h"

BUFFER(restrict, vec4, position)
BUFFER(readonly, uint, idAndMaterial)
BUFFER(restrict, uvec4, images)

// Most that are counted at once: more would be no whole numbers.
#define MOST_TURNS 1.0e6f

uint counted(float turns) {
    return uint(int(min(max(turns, -MOST_TURNS), MOST_TURNS)));
}

KERNEL(params.spheres) {
    vec4 sphere = position[invocation];
    if (!finite3(vec3(sphere))) return;
    vec3 outside = turnsOf(vec3(sphere));
    if (outside.x == 0.0f && outside.y == 0.0f && outside.z == 0.0f) return;
    position[invocation] = withXyz(sphere, movedBack(vec3(sphere), outside));
    uint id = idOf(idAndMaterial[invocation]);
    uvec4 before = images[id];
    images[id] = uvec4(before.x + counted(outside.x), before.y + counted(outside.y), before.z + counted(outside.z), 0u);
}

// Last pass of the figures of each sphere: puts them side by side for the codec. Fixed spheres have no energy.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, velocity)
BUFFER(readonly, vec4, angularVelocity)
BUFFER(readonly, uint, touching)  // spheres, walls and obstacles that each sphere touches
BUFFER(readonly, uint, deepest)   // bits of the largest overlap / r of each sphere
BUFFER(writeonly, vec4, figures)  // contacts, overlap / r, kinetic energy (J)

KERNEL(params.spheres) {
    vec4 v = velocity[invocation];
    precise float energy = 0.0f;
    if (!isFixed(v)) {
        float mass = 1.0f / inverseMassOf(v);
        energy = 0.5f * mass * dot3(vec3(v), vec3(v));
        if (HAS(FRICTION)) {
            vec3 spin = vec3(angularVelocity[invocation]);
            float r = radiusOf(position[invocation]);
            precise float rotation = 0.2f * mass * r * r * dot3(spin, spin);
            energy = energy + rotation;
        }
    }
    figures[invocation] = vec4(float(touching[invocation]), uintBitsToFloat(deepest[invocation]), energy, 0.0f);
}

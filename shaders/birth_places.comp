// Finds the places for new spheres that are taken by a sphere. The phase of the launch is the number of chunks of places.
#include "shared/kernel.h"
#include "shared/layout.h"
PARAMETERS
#include "shared/accessors.h"
#include "shared/math.h"
#include "shared/separation.h"

BUFFER(readonly, vec4, position)
BUFFER(readonly, vec4, birthPlaces)
BUFFER(coherent, uint, birthTaken)  // 1: taken

KERNEL(params.spheres) {
    vec4 sphere = position[invocation];
    float radius = radiusOf(sphere);
    for (uint chunk = 0u; chunk < phase; ++chunk) {
        uint row = chunk * BIRTH_CHUNK_ROWS;
        vec3 apart = separation(vec3(sphere), vec3(birthPlaces[row]));
        vec4 sides = birthPlaces[row + 1u];
        bool near = abs(apart.x) < sides.x + radius && abs(apart.y) < sides.y + radius && abs(apart.z) < sides.z + radius;
        if (!near) continue;
        for (uint k = 0u; k < BIRTH_CHUNK; ++k) {
            vec4 place = birthPlaces[row + 2u + k];
            if (place.w == 0.0f) break;
            vec3 d = separation(vec3(sphere), vec3(place));
            float reach = radius + place.w;
            precise float square = dot3(d, d);
            if (square < reach * reach) atomicOr(birthTaken[chunk * BIRTH_CHUNK + k], 1u);
        }
    }
}

// Where spheres are drawn: between two states, and again across the faces of periodic axes.

vec3 positionNow(int place) {
    vec3 from = positionFrom(place);
    return shortest(from + u_mix * shortest(positionTo(place) - from));
}

// The image across the faces of some periodic axes. `axes`: 1 for these axes, else 0.
vec3 imageOf(vec3 position, vec3 axes) { return position - axes * u_period * sign(position); }

// Whether an image of a sphere reaches into the bounds. The sphere itself is always drawn.
bool isInside(vec3 position, float radius, vec3 axes) {
    return all(greaterThanEqual(abs(position) + radius, 0.5 * axes * u_period));
}

// The code of a sphere in the image of codes: bit 31 is set, bits 24 to 26 are the axes of the image, and the others
// are the place. The code 0 means that there is no sphere.
const uint isSphere = 0x80000000u;

uint codeOf(int place, uint imageBits) { return isSphere | (imageBits << 24) | uint(place); }

int placeOf(uint code) { return int(code & 0xffffffu); }

vec3 axesOf(uint code) { return vec3((uvec3(code) >> uvec3(24u, 25u, 26u)) & 1u); }

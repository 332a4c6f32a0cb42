// Where spheres are drawn: between two states, and again across the faces of periodic axes.

// A sphere, or its image across the faces of some periodic axes.
struct Spot {
    vec3 inside;    // m, relative to the centre of the bounds: the sphere itself, which is in the bounds
    vec3 to;        // m, relative to the eye
};

// `axes`: 1 for the axes across whose faces the image is, else 0. All lengths of axes are subtracted at once: near the
// eye there are none, and the position keeps its precision.
Spot spotOf(int place, vec3 axes) {
    vec3 from = fromEye(positionFrom(place), 0);
    vec3 near = from + u_mix * shortest(fromEye(positionTo(place), 1) - from);
    vec3 turns = turnsIn(eye.xyz + near);
    vec3 inside = eye.xyz + near - u_period * turns;
    return Spot(inside, near - u_period * (turns + axes * sign(inside)));
}

// Whether an image of a sphere reaches into the bounds. The sphere itself is always drawn.
bool isInside(Spot spot, float radius, vec3 axes) {
    return all(greaterThanEqual(abs(spot.inside) + radius, 0.5 * axes * u_period));
}

// The code of a sphere in the image of codes: bit 31 is set, bits 24 to 26 are the axes of the image, and the others
// are the place. The code 0 means that there is no sphere.
const uint isSphere = 0x80000000u;

uint codeOf(int place, uint imageBits) { return isSphere | (imageBits << 24) | uint(place); }

int placeOf(uint code) { return int(code & 0xffffffu); }

vec3 axesOf(uint code) { return vec3((uvec3(code) >> uvec3(24u, 25u, 26u)) & 1u); }

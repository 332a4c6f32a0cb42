// Where spheres are drawn: between two states, and again across the faces of periodic axes. Relative to the eye (m).

uniform vec3 u_faces[2];    // low and high faces of periodic axes; beyond all spheres for other axes

// `axes`: 1 for the axes across whose faces an image of the sphere is, else 0. All lengths of axes are subtracted at
// once: near the eye there are none, and the position keeps its precision.
vec3 placeNow(int place, vec3 axes) {
    vec3 from = fromEye(positionFrom(place), 0);
    vec3 near = from + u_mix * shortest(fromEye(positionTo(place), 1) - from);
    vec3 turns = turnsIn(eye.xyz + near);
    vec3 side = sign(eye.xyz + near - u_period * turns);
    return near - u_period * (turns + axes * side);
}

// Whether a sphere or an image of it reaches into the bounds.
bool isInside(vec3 to, float radius) {
    return all(greaterThanEqual(to + radius, u_faces[0])) && all(lessThanEqual(to - radius, u_faces[1]));
}

// The code of a sphere in the image of codes: bit 31 is set, bits 24 to 26 are the axes of the image, and the others
// are the place. The code 0 means that there is no sphere.
const uint isSphere = 0x80000000u;

uint codeOf(int place, uint imageBits) { return isSphere | (imageBits << 24) | uint(place); }

int placeOf(uint code) { return int(code & 0xffffffu); }

vec3 axesOf(uint code) { return vec3((uvec3(code) >> uvec3(24u, 25u, 26u)) & 1u); }

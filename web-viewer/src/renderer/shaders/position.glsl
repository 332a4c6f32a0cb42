// The position of a sphere (m, relative to the centre of the bounds): two states, interpolated. program.ts declares the
// inputs of the columns.
in float a_radius;         // m; 0: no sphere is at this place

uniform float u_mix;
uniform vec3 u_period;     // m: length of each periodic axis; 0: not periodic
uniform vec3 u_perLength;  // 1/m: 1 over these lengths, or 0
uniform vec3 u_image;      // 1 for the axes across whose faces images are drawn, else 0

// A distance (m) by the shortest way along periodic axes.
vec3 shortest(vec3 distance) { return distance - u_period * floor(distance * u_perLength + 0.5); }

vec3 placeNow() { return shortest(a_positionFrom + u_mix * shortest(a_positionTo - a_positionFrom)); }

vec3 centreNow() {
    vec3 place = placeNow();
    return place - u_image * u_period * sign(place);
}

// Whether there is a sphere, and its image reaches into the bounds. The sphere itself is always drawn.
bool isDrawn() {
    return a_radius > 0.0 && all(greaterThanEqual(abs(placeNow()) + a_radius, 0.5 * u_image * u_period));
}

// What the host and the kernels agree on. Lengths in m, relative to the centre of the bounds; times in s.

#define MOST_LEVELS 8u

// The uniform block, std140: vectors first, then scalars in fours.
struct Parameters {
    vec4 gravity;        // xyz in m/s^2; w = 0
    vec4 wallMin;        // domain walls
    vec4 wallMax;
    vec4 law;            // of two spheres where all have one material: ContactParams.contact
    vec4 stiffness;      // the same: ContactParams.stiffness
    vec4 levelSize[MOST_LEVELS];    // 1 / cell size, largest radius, crowdOf, 0; from the finest level to the coarsest
    uvec4 cells;         // per axis, multiples of 4; w = all cells, of all levels
    uvec4 levelCells[MOST_LEVELS];  // per axis, multiples of 4; w = the first of them among all cells

    float substep;       // h
    float perSubstep;    // 1 / h
    float inverseCell;   // 1 / cell size
    float margin;        // pairs are listed up to this gap

    float rebuildMove;   // lists hold until a sphere has moved this far; below margin / 2
    float radius;        // of every sphere where radii are equal
    float deadBand;      // m/s; slower approaches of spheres do not bounce in the model `fast`
    float step;          // s; after each, substeps are fitted to how fast spheres are

    float sleepSpeed;    // m/s
    float sleepTime;     // s
    float wakeSpeed;     // m/s
    float creep;         // m; who moves this far from where it was is no longer at rest

    uint spheres;
    uint groups;         // of 2 x 2 x 2 cells, of one colour, of all levels
    uint pairCapacity;
    uint closedFaces;    // bit per face: x- x+ y- y+ z- z+

    uint planes;
    uint boxes;
    uint statisticBlocks;
    uint materials;

    uint material;       // of every sphere where all have one
    uint wallMaterial;   // of the bounds
    uint wallContacts;   // that a sphere remembers
    uint levels;
};

// What holds between two materials. Row a, column b of the `contactParams`.
struct ContactParams {
    vec4 contact;        // restitution, friction, rolling resistance, spinning resistance
    vec4 stiffness;      // of the model `accurate`: normal (Pa), damping ratio, tangential (Pa), 0
};

// Solid obstacles. A plane: normal and offset; a box: its corners; its material in the second w.
struct Obstacle {
    vec4 a;
    vec4 b;
};

// Sums over a block of spheres.
struct SphereStatistics {
    vec4 weighted;          // sum of m x; w: sum of m
    vec4 momentum;          // sum of m v; w: sum of m v^2 / 2
    vec4 angular;           // sum of m x cross v + I spin; w: sum of I spin^2 / 2
    float heightSum;        // of z
    float speedSquares;     // sum of v^2
    float speedSquaredMax;
    float wallOverlapMax;   // depth / r
    float wallSprings;      // sum of what the springs at walls hold, in the model `accurate`
    float unusedReals[3];   // keep the size a multiple of 16 bytes, and what follows aligned for doubles, too
    uint sleeping;
    uint outside;
    uint nonFinite;
    uint unused;
};

// In place of a quiet time: of a sphere that has crept so far that it may carry a sleeper no longer.
#define MOVED_AWAY (-1.0f)

// Words of the `counters` buffer.
#define COUNTER_REBUILD 0u      // lists are to be rebuilt
#define COUNTER_PAIRS 1u        // listed
#define COUNTER_UNLISTED 2u     // cell groups that found no room for their pairs
#define COUNTER_NON_FINITE 3u   // not zero: some sphere has left the numbers
#define COUNTER_FIRST_ID 4u     // ~ the smallest id among them
#define COUNTER_REBUILDS 5u     // since the start
#define COUNTER_SUBSTEPS 6u     // since the start
#define COUNTER_FORGOTTEN 7u    // contacts with walls that found no room for their history, since the start
#define COUNTER_FASTEST 8u      // largest motion in a substep, in radii, as a float's bits; 0: none beyond FAR_MOTION
#define COUNTER_SAMPLED 9u      // cell groups so crowded that only some of their pairs are listed
#define COUNTER_OUTSIDE 10u     // spheres outside the bounds as the lists were built, but for those that are lost
#define COUNTER_FRAME_FALLS 11u // whether the frame of those outside moves
#define COUNTER_FRAME_VELOCITY 12u  // three words, as floats' bits: m/s
#define COUNTER_FRAME_PATH 15u  // the same: m since the lists were built
#define COUNTER_WORDS 18u

// Of more spheres outside, nobody looks how far they are from each other: they have lists as those inside have.
#define MOST_OUTSIDE 1024u

// In a substep a sphere should move less than this share of its radius, or it may pass through what it should hit.
#define FAR_MOTION 0.5f

// Launch sizes that depend on whether the lists are rebuilt: rows of uvec4 (groups x, y, z, 0).
#define LAUNCH_SPHERES 0u
#define LAUNCH_CELLS 1u
#define LAUNCH_BLOCKS 2u
#define LAUNCH_SUPERBLOCKS 3u
#define LAUNCH_ONE 4u
#define LAUNCH_GROUPS 5u
#define LAUNCH_OUTSIDE 6u
#define LAUNCH_OWNERS 7u        // the same for the history of contacts
#define LAUNCH_OWNER_BLOCKS 8u
#define LAUNCH_OWNER_SUPERBLOCKS 9u
#define LAUNCH_ROWS 10u

#define SCAN_BLOCK 256u         // values that one invocation of the prefix sum adds up
#define UNLISTED 0xffffffffu    // pair count of a group without a list
#define STATISTIC_BLOCK 256u    // spheres per partial sum

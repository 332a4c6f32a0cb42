// The layout on which the host and the kernels agree. Lengths in m, relative to the centre of the bounds; times in s.

#define MOST_LEVELS 8u
#define MOST_FIELDS 8u
#define MOST_SINKS 8u

// See shared/fields.h.
#define BOTTOMLESS 1.0e30f
#define IN_BOX -1.0f

// The uniform block, std140: vectors first, then scalars in fours.
struct Parameters {
    vec4 gravity;        // xyz in m/s^2; w = 0
    vec4 wallMin;        // domain walls
    vec4 wallMax;
    vec4 contact;        // ContactParams.contact of two spheres, if all have one material
    vec4 stiffness;      // ContactParams.stiffness of these
    vec4 fieldPlace[MOST_FIELDS];   // of each field: see shared/fields.h
    vec4 fieldNumbers[MOST_FIELDS];
    vec4 fieldVector[MOST_FIELDS];
    vec4 fieldSpin[MOST_FIELDS];
    vec4 fieldLow[MOST_FIELDS];
    vec4 fieldHigh[MOST_FIELDS];
    vec4 sinkMin[MOST_SINKS];       // m: corners of each sink; w of the first: their number
    vec4 sinkMax[MOST_SINKS];
    vec4 levelSize[MOST_LEVELS];    // 1 / cell size, largest radius, sample threshold, 0; from fine to coarse
    vec4 halfLength;     // m: half the length of each periodic axis; 0: not periodic
    vec4 perLength;      // 1/m: 1 / length of each periodic axis; 0: not periodic
    vec4 cellsPerMetre[MOST_LEVELS];  // with periodic axes: 1 / cell width per axis, by level
    uvec4 cells;         // per axis, multiples of 8; w = cells of all levels together
    uvec4 levelCells[MOST_LEVELS];  // per axis, multiples of 8; w = first cell of the level among all cells
    uvec4 levelBundles[MOST_LEVELS];  // first bundle of the level, bundles of one colour, 0, 0

    float substep;       // h
    float perSubstep;    // 1 / h
    float inverseCell;   // 1 / cell size
    float margin;        // pairs are listed up to this gap

    float rebuildMove;   // lists hold until a sphere has moved this far; below margin / 2
    float radius;        // of every sphere, if radii are equal
    float deadBand;      // m/s; slower approaches of spheres do not bounce in the model `fast`
    float step;          // s; after each step, substeps are fitted to the speeds of the spheres

    float sleepSpeed;    // m/s
    float sleepTime;     // s
    float wakeSpeed;     // m/s
    float moveAwayDistance;  // m; a sphere that moves this far from its rest reference has moved away

    uint spheres;
    uint bundles;        // of all colours and levels
    uint pairCapacity;
    uint closedFaces;    // one bit for each face: x- x+ y- y+ z- z+

    uint obstacles;
    uint obstacleListWords;
    uint statisticBlocks;
    uint materials;

    uint material;       // of every sphere, if all have one
    uint wallMaterial;   // of the bounds
    uint maxWallHistory; // contacts with walls that a sphere can remember
    uint levels;

    uint openFaces;      // as closedFaces; a face of a periodic axis is neither
    uint meshWords;      // in obstacleLists, behind the list of all obstacles
    float perImpulseUnit;  // 1/(N s): reciprocal of the unit of impulses on surfaces, a power of two
    float perMomentUnit;   // 1/(N m s): reciprocal of the unit of their moments

    float gravityChange; // m/s: change of the velocity by gravity alone in a substep
    float substepRatio;  // present substep over the one before, while impulses are scaled to it
    float quietSpeed;    // m/s; a sphere that stays below it is quiet
    float obstaclePath;  // m: the most by which a surface of an obstacle moves in a substep

    uint mostMovers;     // spheres that may have lists of their own (shared/movers.h)
    uint farSlot;        // a slot without a sphere, far away from all
    uint moverLevel;     // the level of movers; 0: there is none
    uint firstMoverCell; // the first cell of this level
};

// The contact parameters of two materials: row a, column b of `contactParams`.
struct ContactParams {
    vec4 contact;        // restitution, friction, rolling resistance, spinning resistance
    vec4 stiffness;      // of the model `accurate`: normal (Pa), damping ratio, tangential (Pa), 0
};

// An obstacle. Its shape's function in shapes/ says what is in `a` and `b`. With a frame, the shape lies in the
// frame's own coordinates.
struct Obstacle {
    vec4 a;
    vec4 b;
    vec4 frameX;         // the direction of the frame's x axis; w: x of its origin (m)
    vec4 frameY;
    vec4 frameZ;
    uint shape;          // its number in shapes.def
    uint parts;          // surfaces that a sphere may touch at the same time
    uint surface;        // number of the first of them
    uint material;
    uint framed;         // 1: it has a frame
    uint motion;         // the row of its motion; 0: it is at rest in this substep
    uint cellsAt;        // of a mesh: see mesh_layout.h
    uint nodesAt;
};

// Behind the rows of the obstacles, `obstacles` has a row for the motion of each obstacle that may move. In these rows, a
// is the pivot (m), and b its displacement in this substep (m). frameX is the rotation in this substep: its axis, of the
// length of the tangent of half its angle. frameY is the velocity of the belt (m/s). A driven body (see v1::Drive) has its
// axis in frameZ, with 1/mass (1/kg) or 1/inertia (1/(kg m^2)) as w. Its `shape` is DRIVE_SLIDES or DRIVE_TURNS. Its
// `surface` is the first of its rows in `surfaceSums`. (They are no struct of their own, because finish_substep.comp binds
// as many buffers as a kernel may.) In `balanced`, frames and pivots are as they are at the beginning of a substep, in
// the other models as at its end.

// The buffer obstacleLists has lists of numbers of obstacles in ascending order. It begins with an empty list and the
// list of all obstacles. The words of meshes follow (mesh_layout.h), and then the lists of obstacles near spheres.
#define NO_OBSTACLES 0u
#define ALL_OBSTACLES 1u
#define END_OF_LIST 0xffffffffu
// The lists of obstacles near spheres hold for this number of substeps, however fast obstacles move.
#define OBSTACLE_SUBSTEPS 8.0f

// Springs that pull spheres, in the buffer `pulls`: two rows each. The first has the point (m), and as w the square root of
// stiffness over mass (1/s), 0: there is no spring. The second has the largest acceleration that the spring gives (m/s^2),
// the speed up to which it makes the sphere faster (m/s), and the handle of the sphere. (They are no struct: see
// contact_law.h.)
#define MOST_PULLS 64u
#define PULL_ROWS 2u

// Places for new spheres, in the buffer `birthPlaces`, in chunks. A chunk has two rows and then BIRTH_CHUNK places. The
// rows have the centre of the box of these places (m, relative to the centre of the bounds) and half its sides. A place
// has the position and the radius (m) of the new sphere. The last places of a chunk may have no radius: they are none.
#define MOST_BIRTH_PLACES 8192u
#define BIRTH_CHUNK 64u
#define BIRTH_CHUNK_ROWS (BIRTH_CHUNK + 2u)

// Sums over a block of spheres.
struct SphereStatistics {
    vec4 weighted;          // sum of m x, x without wrapping; w: sum of m
    vec4 momentum;          // sum of m v; w: sum of m v^2 / 2
    vec4 angular;           // sum of m x cross v + I spin; w: sum of I spin^2 / 2
    float heightSum;        // of z
    float speedSquares;     // sum of v^2
    float speedSquaredMax;
    float wallOverlapMax;   // depth / r
    float wallSprings;      // sum of the energies of the springs at walls, in the model `accurate` (J)
    float fieldEnergy;      // sum of the potential energies in the fields (J)
    float unusedReals[2];   // keep the size a multiple of 16 bytes, and the next members aligned for doubles
    vec4 flowDiagonal;      // sum of m v v: xx, yy, zz, 0, in scenes with contact sums (J)
    vec4 flowOther;         // xy, xz, yz, 0
    uint sleeping;
    uint outside;
    uint nonFinite;
    uint fixedSpheres;
};

// The w of a row of `restReference` that marks a sphere as moved away, with a quiet time of 0 (shared/accessors.h).
#define MOVED_AWAY (-1.0f)

// Once in this number of substeps, all spheres that can fall asleep do so together.
#define SLEEP_INTERVAL 32u

// The contacts of an inspected sphere, in the buffer `inspected`: their number, then two words for each of the first
// INSPECTED_MOST. The first word is the id of a sphere, or INSPECTED_SURFACE and the number of a surface. The second word
// is the overlap over the smaller radius, as bits of a float.
#define INSPECTED_MOST 1024u
#define INSPECTED_SURFACE 0x80000000u

// Words of the `counters` buffer.
#define COUNTER_REBUILD 0u      // bits, see below
#define COUNTER_PAIRS 1u        // listed, with the space between bundles
#define COUNTER_UNLISTED 2u     // bundles without room for their pairs
#define COUNTER_NON_FINITE 3u   // not zero: the state of a sphere became non-finite
#define COUNTER_FIRST_ID 4u     // ~ the smallest handle among them
#define COUNTER_REBUILDS 5u     // since the start
#define COUNTER_SUBSTEPS 6u     // since the start
#define COUNTER_DROPPED_WALLS 7u  // contacts with walls without room for their memory, since the start
#define COUNTER_LARGEST_MOTION 8u  // in a substep, in radii, as bits of a float; 0: none beyond SAFE_MOTION
#define COUNTER_SAMPLED 9u      // spheres of which only a sample of the pairs is listed
#define COUNTER_OUTSIDE 10u     // spheres outside the bounds when the lists were built, without lost ones
#define COUNTER_FRAME_FALLS 11u // not 0: the frame of the spheres outside moves
#define COUNTER_FRAME_VELOCITY 12u  // three words, bits of floats (m/s)
#define COUNTER_FRAME_PATH 15u  // three words, bits of floats (m), since the lists were built
#define COUNTER_LISTS 18u       // times that lists were built, also for statistics
#define COUNTER_CANDIDATES 19u  // pairs found by list_build.comp
#define COUNTER_CARRIED 20u     // contacts remembered when the lists were rebuilt
#define COUNTER_RESTORED 21u    // contacts among them that the new lists hold
#define COUNTER_RESTING 22u     // bits RESTS and RESTED_BEFORE
#define COUNTER_DRIFT_BOX 23u   // six words: the box of the velocities when the lists were built (list_drift.comp)
#define COUNTER_DRIFT 29u       // three words, bits of floats (m/s)
#define COUNTER_DRIFT_PATH 32u  // three words, bits of floats (m), since the lists were built
#define COUNTER_NEAR_OBSTACLES 35u  // words of the lists of obstacles near spheres
#define COUNTER_SUNK 36u        // spheres in sinks at the end of a step
#define COUNTER_CUT_SHORT 37u   // bundles or groups of cells whose lists the renderer cut short, since the start
#define COUNTER_OBSTACLE_PATH 38u // bits of a float (m): the most that obstacles have moved since the lists were built
#define COUNTER_LEAVING 39u     // spheres that soon become movers; any number above params.mostMovers if more do
#define COUNTER_BORN 40u        // spheres that were added since the lists were built
// The lists of movers (shared/movers.h):
#define COUNTER_MOVERS 41u      // spheres in them
#define COUNTER_MOVERS_ALONE 42u  // not 0: the last lists that were built are of movers alone
#define COUNTER_MOVER_LISTS 43u // times that they were built since the lists of all spheres were
#define COUNTER_SORTED 44u      // spheres in the lists of all spheres
#define COUNTER_MOVER_PAIRS 45u // where their pairs begin
#define COUNTER_PAIR_LIMIT 46u  // where the room for the pairs of the last lists ends
#define COUNTER_ALL_PAIRS 47u   // where the pairs of the lists of all spheres end
#define COUNTER_MOVER_ROOM 48u  // spheres for which the lists of movers that are built have room
#define COUNTER_AWAKE_MOVERS 49u  // in the last substep
#define COUNTER_WORDS 50u

// Bits of COUNTER_REBUILD. The host launches the kernels of a rebuild only if one of the first three was set at the end of
// the substep before the last one.
#define REBUILD_DUE 1u          // lists are to be rebuilt
#define REBUILD_SOON 2u         // in the last substep, a sphere was SOON_SUBSTEPS away from asking for new lists
#define REBUILD_WAS_SOON 4u     // the same, if spheres move before rebuild_decide.comp
#define LISTS_MISSING 8u        // there was no room for the present lists
#define REBUILD_ALL 16u         // lists of movers alone are not enough
#define MOVERS_EXIST 32u        // there are lists of movers
// Three times as many as the host is ahead: a heavy sphere that meets a light one at equal and opposite speeds makes it
// three times as fast.
#define SOON_SUBSTEPS 6.0f

// A bit of the phase of wake.comp, above level and colour.
#define LEAVERS 0x10000u

// Bits of COUNTER_RESTING.
#define RESTS 1u                // spheres sleep, have slept since the lists were built, or are fixed
#define RESTED_BEFORE 2u        // the same for the lists before, while the lists are rebuilt

// If more spheres are outside, their distances from each other are not computed, and each has a room of one margin.
#define MOST_OUTSIDE 1024u

// A sphere should move less than this share of its radius in a substep. Otherwise it may pass through an object that it
// should hit.
#define SAFE_MOTION 0.5f

// Launch sizes that depend on whether the lists are rebuilt: rows of uvec4 (groups x, y, z, count). Kernels over bundles,
// over groups of cells and over runs of cells have a work group for each.
#define LAUNCH_SPHERES 0u       // spheres whose lists are built
#define LAUNCH_CELLS 1u
#define LAUNCH_BLOCKS 2u
#define LAUNCH_SUPERBLOCKS 3u
#define LAUNCH_ONE 4u
#define LAUNCH_GROUPS 5u        // groups of cells
#define LAUNCH_OUTSIDE 6u
#define LAUNCH_FIT 7u           // an invocation for each bundle
#define LAUNCH_BUNDLES 8u       // bundles
#define LAUNCH_COLOUR 9u        // bundles of one colour of the largest level
#define LAUNCH_LEVEL 10u        // bundles of the largest level
#define LAUNCH_CELL_RUNS 11u    // runs of ORDERED_CELLS cells
#define LAUNCH_COLUMNS 12u      // spheres, if all are sorted
#define LAUNCH_MOVER_LEVEL 13u  // bundles of the level of movers
#define LAUNCH_COLLECT 14u      // this row to LAUNCH_FORGET: only if lists of movers alone are built. All spheres
#define LAUNCH_MOVER_CELLS 15u  // one
#define LAUNCH_FORGET 16u       // bundles
#define LAUNCH_LOST_SPHERES 17u // this row and the next: only if a contact is remembered that the new lists lack
#define LAUNCH_LOST_COLOUR 18u  // bundles of one colour
#define LAUNCH_UNLISTED 19u     // in each substep while there are no lists: an invocation for each bundle of a colour
#define LAUNCH_MOVERS 20u       // in each substep while there are movers: bundles of a colour of their level
#define LAUNCH_ROWS 21u
// `dispatchSizes` has two tables of these rows: for lists of all spheres, and for lists of movers alone.

#define LAUNCH_THREADS 64u      // of a work group of a kernel over spheres

#define ORDERED_CELLS 64u       // cells whose spheres a work group puts in order

#define SCAN_BLOCK 256u         // values that one invocation of the prefix sum adds up
#define UNLISTED 0xffffffffu    // pair count of a bundle without a list
#define ACTIVE 1u               // a sphere of the bundle, or around it, is awake
#define WAKERS 2u               // such a sphere may wake others
#define SLEEPERS 4u             // some spheres of the scene sleep
#define STATISTIC_BLOCK 256u    // spheres per partial sum

// The order of pairs: see shared/bundles.h.
#define BLOCKS_PER_BUNDLE 4u
#define HASHED_BATCHES 16u      // the hash of a pair chooses among these
#define BATCHES 24u             // further pairs of a bundle come one by one
#define BUNDLE_WORDS 32u        // first pair, listed pairs, bits ACTIVE to SLEEPERS, 0, the ends of the batches, the end of all pairs
// Words behind the last bundle, for the solver, which binds as many buffers as a kernel may.
#define WORD_FASTEST 0u         // largest squared speed in this substep, relative to the drift, as bits of a float;
                                // without movers
#define WORD_HALF 1u            // first element of the contact memory of the present lists (shared/contact_memory.h)
#define WORD_FASTEST_MOVER 2u   // the largest squared speed of movers
// Behind these words are rows of contact sums for each bundle and thread (shared/contact_sums.h).
#define BUNDLE_THREADS 64u      // parts in which the statistics of a bundle are added up
#define MOST_PAIR_THREADS 256u  // of PAIR_KERNEL
#define SUM_WORDS 8u            // virial xx yy zz xy xz yz (J s), collisions, 0
// Sums over the contacts with each surface (shared/surface_sums.h).
#define SURFACE_SUM_COPIES 16u
#define SURFACE_SUM_WORDS 12u   // impulse x y z, moment x y z: low and high words
// Each driven body has further rows behind the surfaces. The first row sums what the spheres get from it, and the second
// the part that contacts hold. The first word of the third row is the number of contacts.
#define DRIVE_SUM_ROWS 3u
#define DRIVE_SLIDES 1u
#define DRIVE_TURNS 2u
#define PAIR_PADDING 16u        // unused pairs behind each bundle: lanes beyond the last pair lie here

// A sphere carries over at most this many contacts when the lists are rebuilt. A sphere touches at most 12 others that
// are no smaller.
#define CARRIED_MOST 16u

// The bits of the components of a sphere's own acceleration, whose words are `accelerationXz` and `accelerationYz`.
// They have the upper 21 bits of x or y, then the upper 11 and the lower 10 of the 21 bits of z. A component loses up
// to 2^-12 of itself, so that a mean over eight substeps ends up to 8 * 2^-12 below a constant.
#define ACCELERATION_BITS 0xfffff800u
#define ACCELERATION_X_BITS(xz, yz) ((xz) & ACCELERATION_BITS)
#define ACCELERATION_Y_BITS(xz, yz) ((yz) & ACCELERATION_BITS)
#define ACCELERATION_Z_BITS(xz, yz) (((xz) << 21u) | (((yz) & 0x3ffu) << 11u))

// In the second number of a listed pair: its contact remembers something (shared/contact_memory.h).
#define PAIR_REMEMBERS 0x80000000u
#define SECOND_OF(pair) ((pair).y & ~PAIR_REMEMBERS)

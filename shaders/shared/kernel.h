// Makes a .comp file both a GLSL compute shader and the body of a C++ struct.
//
//   BUFFER(access, type, name)  Declares the storage buffer `name[]`, on a line of its own, in a .comp file. Access is
//                               readonly, writeonly, restrict (both) or coherent (atomics). The host writes its GLSL
//                               (compute/source.h), because the macro language of GLSL cannot form the block's name.
//   KERNEL(count) { ... }       Defines the body; `invocation` runs over 0 .. count - 1.
//   HAS(FEATURE)                Is true if the scene requires the feature: a constant in GLSL, a value in C++.
//   PREFETCH(element)           Announces that an element of a buffer is read soon. It has an effect on CPUs only.
//   SEEN(word)                  The present value of a uint that other invocations may change by atomic functions.
//   PRIVATE(type, name)         Declares a variable of the invocation that functions share.
//   LOOP_LIMIT                  The device ends all loops of an invocation after this number of iterations together.
//                               NO_LOOP_LIMIT: it does not.
//
// A kernel that begins with one of these macros does the same work for several lanes at once. GLSL has one lane per
// invocation; C++ has 1, 4, 8 or 16. Results do not depend on the number of lanes.
//
//   LANE_KERNEL(count) { ... }  Defines the body; `invocation` is a uintRow that runs over 0 .. count - 1.
//   LANE_BUNDLE_KERNEL(count) { ... }  BUNDLE_KERNEL (see below), whose threads use lanes for their own loops.
//   LANES                       The number of lanes.
//   ROWS_UP_TO(first, end)      The uintRow from `first` on. Lanes with numbers from `end` on do not exist.
//   IN_ROWS(at)                 The mask of the lanes that exist.
//   LANE_PAIR_KERNEL            Visits the listed pairs of the bundles of the launch's colour, batch after batch
//   PAIR_KERNEL                 (shared/bundles.h). The same with one lane in C++ too. The includer defines
//                               `bool beginBundle(uint bundle)`, which returns false to skip the bundle, and
//                               `void visitPairs(slots a, slots b, uintRow at)`, where `at` is the number of the pair,
//                               and `void endBundle(uint bundle)`, which each thread calls at the end. `b` may have
//                               PAIR_REMEMBERS (shared/layout.h). visitPairs may change this bit of its own pair alone,
//                               in `coherent` pairs: other threads read the pairs of later batches.
//                               With lanes, also `bool expectsPairs()`, which returns true if it is worth while that
//                               `void expectPairs(uint first, uint count)` prefetches the data of later pairs.
//
//   real, real3, real4, mask    Values per lane: float, vec3, vec4 and bool in GLSL.
//   uints                       A number per lane.
//   slots                       The slot of a sphere per lane.
//   uintRow                     Consecutive numbers, one per lane.
//   ANY_REAL, ANY_REAL3, ANY_REAL4, ANY_MASK, ANY_UINT  Types in functions for values per lane and for single values.
//   ROW(array, at)              The elements of a buffer at `at`: uints, slots or a uintRow.
//   SET_ROW(where, array, at, to, old)  Sets the elements of the lanes in `where`. `old`: their present values.
//   SET_ALL(array, at, to)      Sets the elements of all lanes of a uintRow. Elements of lanes
//                               that do not exist must keep their values, or be of no use.
//   MEMBER(array, at, member)   A vec4 member of the structs of a buffer, or a component of its vectors.
//   REMEMBERS(pairs, b, at)     Whether the pairs that visitPairs gets have PAIR_REMEMBERS. Lanes that do not exist
//                               have the bits of the pairs that follow.
//   SLOTS_OF(b)                 The slots of the second spheres.
//   wholeOf(value)              The whole number of a real from 0 to 2^24.
//   RARE                        Before a function: keeps it out of the code around its calls.
//   EACH_LANE(where, function, at)  Calls the function with the number of each lane in `where`.
//   EACH_LANE_WITH(where, flag, function, at)  The same for a uintRow, in order, with the bool of a second mask.
//   EACH_LANE_VECTORS(where, function, number, more, a, b)  Calls the function with the number, `more` and the vec3 of
//                               each lane in `where`. `number`: uints. `more`: any value. `a`, `b`: real3.
//   EACH_LANE_NUMBER(where, function, more)  Calls the function with the number of each lane in `where` among the lanes,
//                               and `more`, any value.
//   LANE_OF(value, lane)        The value of one lane of a real, a real3 or uints. Uints can be set.
//   SUM_OF_LANES(value)         The sum of a real over the lanes.
//   RAISE_TO(where, word, value)    Raises a word, the bits of a float, to the value of the lanes in `where`, >= 0.
//
// A bundle of pairs, a group of cells or a run of cells is the work of a work group on a GPU, and of one thread in C++.
//
//   BUNDLE_KERNEL(count) { ... }  Defines the body of all threads of a work group; `invocation` is the group's number.
//                               It is launched with a number of work groups, as PAIR_KERNEL is.
//   PAIR_THREADS                The number of threads of a work group of PAIR_KERNEL, which the device chooses.
//   THREAD                      The number of the thread in its work group; 0 in C++.
//   THREADS                     The threads of a work group of BUNDLE_KERNEL, as many as suit the device; 1 in C++.
//   FIRST_THREAD                True in one thread of the work group.
//   SHARED(type, name)          Declares a variable of the work group.
//   BARRIER                     Waits for all threads, and shows each what the others have written to such variables.
//   BUFFER_BARRIER              The same, and for buffers that are declared `coherent`.
#ifndef __cplusplus

// NVIDIA's compiler unrolls loops and copies functions into each call, which takes long. Others ignore this.
#pragma optionNV(unroll none)

#ifndef LOCAL_SIZE
#define LOCAL_SIZE 64
#endif
#ifndef GROUP_THREADS
#define GROUP_THREADS 64
#endif
#ifndef PAIR_THREADS
#define PAIR_THREADS 64
#endif
#define THREADS_OF_GROUP(count) layout(local_size_x = count) in;
layout(location = 0) uniform uint phase;

#define NO_LOOP_LIMIT 0xffffffffu
#ifndef LOOP_LIMIT
#define LOOP_LIMIT NO_LOOP_LIMIT
#endif
#define PRIVATE(type, name) type name;
#define PREFETCH(element)
#define HAS(feature) (feature)
#define PARAMETERS layout(std140, binding = 0) uniform ParameterBlock { Parameters params; };
#define KERNEL(count)                                                                            \
    THREADS_OF_GROUP(LOCAL_SIZE)                                                                 \
    void kernelBody(uint invocation);                                                            \
    void main() {                                                                                \
        uint row = gl_NumWorkGroups.x * uint(LOCAL_SIZE);                                        \
        uint invocation = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * row;               \
        if (invocation < (count)) kernelBody(invocation);                                        \
    }                                                                                            \
    void kernelBody(uint invocation)

#define real float
#define real3 vec3
#define real4 vec4
#define mask bool
#define uints uint
#define slots uint
#define uintRow uint
#define row4 vec4  // as a function it would take glslang minutes
#define ANY_REAL float
#define ANY_REAL3 vec3
#define ANY_REAL4 vec4
#define ANY_MASK bool
#define ANY_UINT uint
#define ROW(array, at) array[at]
#define SET_ROW(where, array, at, to, old) if (where) array[at] = to;
#define SET_ALL(array, at, to) array[at] = to;
#define MEMBER(array, at, member) array[at].member
#define EACH_LANE(where, function, at) if (where) function(at);
#define RAISE_TO(where, word, value)                                                             \
    if (where && word < floatBitsToUint(value)) atomicMax(word, floatBitsToUint(value));
#define SEEN(word) (word)
#define REMEMBERS(pairs, b, at) (((b) & PAIR_REMEMBERS) != 0u)
#define SLOTS_OF(b) ((b) & ~PAIR_REMEMBERS)
#define LANE_KERNEL(count) KERNEL(count)
#define EACH_LANE_WITH(where, flag, function, at) if (where) function(at, flag);
#define EACH_LANE_VECTORS(where, function, number, more, a, b) if (where) function(number, more, a, b);
#define EACH_LANE_NUMBER(where, function, more) if (where) function(0u, more);
#define LANE_OF(value, lane) value
#define ROWS_UP_TO(first, end) (first)
#define IN_ROWS(at) true
#define LANES 1u
#define RARE
#define SUM_OF_LANES(value) (value)
#define THREAD gl_LocalInvocationID.x
#define THREADS uint(GROUP_THREADS)
#define FIRST_THREAD (THREAD == 0u)
#define SHARED(type, name) shared type name;
#define BARRIER            \
    memoryBarrierShared(); \
    barrier();
#define BUFFER_BARRIER    \
    groupMemoryBarrier(); \
    barrier();
#define BUNDLE_KERNEL(count)                                                                     \
    THREADS_OF_GROUP(GROUP_THREADS)                                                              \
    void kernelBody(uint invocation);                                                            \
    void main() {                                                                                \
        uint index = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;                   \
        if (index < (count)) kernelBody(index);                                                  \
    }                                                                                            \
    void kernelBody(uint invocation)
// The next pair of each thread is read before the barrier. Pairs beyond the last batch are batches of one pair.
#define PAIR_KERNEL                                                                              \
    THREADS_OF_GROUP(PAIR_THREADS)                                                               \
    shared uint batchEnds[BATCHES];                                                              \
    void main() {                                                                                \
        uint index = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;                   \
        if (index >= bundlesOfPhase()) return;                                                   \
        uint bundle = bundleOfPhase(index);                                                      \
        if (!beginBundle(bundle)) return;                                                        \
        for (uint k = THREAD; k < BATCHES; k += uint(PAIR_THREADS)) batchEnds[k] = endOfBatch(bundle, k);\
        BARRIER                                                                                  \
        uint from = firstPair(bundle);                                                           \
        uint end = endOfPairs(bundle);                                                           \
        uvec2 next = uvec2(0u, 0u);                                                              \
        if (from + THREAD < end) next = pairs[from + THREAD];                                    \
        for (uint batch = 0u; from < end; ++batch) {                                             \
            uint to = batch < BATCHES ? batchEnds[batch] : from + 1u;                            \
            if (from == to) continue;                                                            \
            uvec2 pair = next;                                                                   \
            if (to + THREAD < end) next = pairs[to + THREAD];                                    \
            for (uint k = from + THREAD; k < to; k += uint(PAIR_THREADS)) {                      \
                if (k >= from + uint(PAIR_THREADS)) pair = pairs[k];                             \
                visitPairs(pair.x, pair.y, k);                                                   \
            }                                                                                    \
            from = to;                                                                           \
            BUFFER_BARRIER                                                                       \
        }                                                                                        \
        endBundle(bundle);                                                                       \
    }
#define LANE_PAIR_KERNEL PAIR_KERNEL
#define LANE_BUNDLE_KERNEL(count) BUNDLE_KERNEL(count)

bool anyLane(bool m) { return m; }
bool noLane() { return false; }
bool liveLanes() { return true; }
bool finiteLanes(vec3 a) {
    return (floatBitsToUint(a.x) & 0x7f800000u) != 0x7f800000u && (floatBitsToUint(a.y) & 0x7f800000u) != 0x7f800000u &&
           (floatBitsToUint(a.z) & 0x7f800000u) != 0x7f800000u;
}
uint leastOf(uint a) { return a; }
#define wholeOf(value) uint(value)  // as a function it would take glslang minutes
float select(bool m, float yes, float no) { return m ? yes : no; }
uint select(bool m, uint yes, uint no) { return m ? yes : no; }
vec3 select(bool m, vec3 yes, vec3 no) { return m ? yes : no; }
vec4 select(bool m, vec4 yes, vec4 no) { return m ? yes : no; }

#endif

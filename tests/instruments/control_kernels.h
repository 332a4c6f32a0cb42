// Kernels with a planted fault. Each fault is what an instrument must report.
#pragma once

namespace spherule::compute::cpu::SPHERULE_PRECISION {

#define CONTROL(name, ...)            \
    struct name : KernelBase {        \
        using KernelBase::KernelBase; \
        static constexpr BufferDeclaration declared[] = {__VA_ARGS__};

// Invocations take places in the order in which they run.
CONTROL(places_by_arrival, {"uint", "next"}, {"uint", "places"})
BUFFER(coherent, uint, next)
BUFFER(writeonly, uint, places)
KERNEL(64U) {
    places[atomicAdd(next[0], 1U)] = invocation;
}
};

// An invocation reads what another one writes.
CONTROL(reads_neighbour, {"uint", "values"})
BUFFER(restrict, uint, values)
KERNEL(64U) {
    values[invocation] = values[(invocation + 1U) % 64U] + 1U;
}
}
;

// Two invocations write one word.
CONTROL(writes_one_word, {"uint", "values"})
BUFFER(writeonly, uint, values)
KERNEL(64U) {
    values[invocation / 2U] = 1U;
}
}
;

// An invocation reads a word without atomics that others change.
CONTROL(reads_counter, {"uint", "counter"}, {"uint", "seen"})
BUFFER(coherent, uint, counter)
BUFFER(writeonly, uint, seen)
KERNEL(64U) {
    atomicAdd(counter[0], 1U);
    if (invocation == 5U) seen[0] = counter[0];
}
}
;

// A thread reads a variable of the work group that another one has written, without a barrier.
CONTROL(without_barrier, {"uint", "values"})
BUFFER(writeonly, uint, values)
SHARED(uint, numbers[64])
BUNDLE_KERNEL(4U) {
    numbers[THREAD] = invocation + THREAD;
    values[invocation * 64U + THREAD] = numbers[63U - THREAD];
}
}
;

// Threads exchange values by a buffer across a barrier that does not order accesses to buffers.
CONTROL(barrier_without_buffers, {"uint", "values"})
BUFFER(coherent, uint, values)
BUNDLE_KERNEL(4U) {
    values[invocation * 64U + THREAD] = THREAD;
    BARRIER
    values[invocation * 64U + 63U - THREAD] += 1U;
}
}
;

// Threads exchange values by a buffer that is not coherent.
CONTROL(not_coherent, {"uint", "values"})
BUFFER(restrict, uint, values)
BUNDLE_KERNEL(4U) {
    values[invocation * 64U + THREAD] = THREAD;
    BUFFER_BARRIER
    values[invocation * 64U + 63U - THREAD] += 1U;
}
}
;

// The same without a fault.
CONTROL(coherent_across_barrier, {"uint", "values"})
BUFFER(coherent, uint, values)
SHARED(uint, numbers[64])
BUNDLE_KERNEL(4U) {
    values[invocation * 64U + THREAD] = THREAD;
    numbers[THREAD] = invocation + THREAD;
    BUFFER_BARRIER
    values[invocation * 64U + 63U - THREAD] += numbers[63U - THREAD];
}
}
;

// Some threads end before a barrier.
CONTROL(ends_before_barrier, {"uint", "values"})
BUFFER(writeonly, uint, values)
BUNDLE_KERNEL(1U) {
    if (THREAD > 40U) return;
    BARRIER
    values[THREAD] = 1U;
}
}
;

// Threads wait at different barriers.
CONTROL(two_barriers, {"uint", "values"})
BUFFER(writeonly, uint, values)
BUNDLE_KERNEL(1U) {
    if (THREAD == 7U) {
        BARRIER
    } else {
        BARRIER
    }
    values[THREAD] = 1U;
}
}
;

// The pairs of the launch in one batch: pairs k and k + 1 share a sphere.
CONTROL(shares_sphere, {"uint", "values"})
BUFFER(coherent, uint, values)
BUNDLE_KERNEL(1U) {
    values[THREAD] = values[THREAD] + 1U;
    values[THREAD + 1U] = values[THREAD + 1U] + 1U;
}
}
;

// The first invocation of a kernel does not set a variable that it uses.
CONTROL(reads_shared_before, {"uint", "values"})
BUFFER(writeonly, uint, values)
SHARED(uint, number)
BUNDLE_KERNEL(4U) {
    if (FIRST_THREAD && invocation == 2U) number = 1U;
    BARRIER
    values[invocation * 64U + THREAD] = number;
}
}
;

#undef CONTROL
#define CONTROL(name) \
    { #name, name::declared, false, &countOf < name>, 1, &run < name> }
constexpr Entry controls[] = {
    CONTROL(places_by_arrival), CONTROL(reads_neighbour),         CONTROL(writes_one_word),
    CONTROL(reads_counter),     CONTROL(without_barrier),         CONTROL(barrier_without_buffers),
    CONTROL(not_coherent),      CONTROL(coherent_across_barrier), CONTROL(ends_before_barrier),
    CONTROL(two_barriers),      CONTROL(shares_sphere),           CONTROL(reads_shared_before),
};
#undef CONTROL

}  // namespace spherule::compute::cpu::SPHERULE_PRECISION

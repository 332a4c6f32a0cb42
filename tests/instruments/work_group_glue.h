// Compiles kernels as C++ for work groups of 64 threads. Included after compute/cpu/glue.h, which defines them for one
// thread, and before all_kernels.h. SPHERULE_PRECISION is a namespace within the one of glue.h.
//
// PAIR_KERNEL is the text of shaders/shared/kernel.h, as a GPU runs it.
#pragma once

#include <new>
#include <stdexcept>

#include "work_groups.h"

namespace spherule::compute::cpu::SPHERULE_PRECISION {

struct WorkGroupNumber {
    uint x = 0;
    uint y = 0;
};

struct KernelBase : glue::KernelBase {
    explicit KernelBase(const Binding& bound) : glue::KernelBase(bound) {}

    // Notes the access of the buffer in a slot. Returns the slot.
    std::size_t readonlySlot(std::size_t slot) { return slot; }
    std::size_t writeonlySlot(std::size_t slot) { return slot; }
    std::size_t restrictSlot(std::size_t slot) { return slot; }
    std::size_t coherentSlot(std::size_t slot) {
        coherentSlots |= 1U << slot;
        return slot;
    }

    uint coherentSlots = 0;  // bits
    uint thread = 0;
    WorkGroupNumber gl_WorkGroupID;
    WorkGroupNumber gl_NumWorkGroups{1, 1};
};

template <class Kernel>
uint countOf(const Binding& binding) {
    Kernel kernel(binding);
    uint count = 0;
    if constexpr (requires { kernel.kernelCount(); })
        count = kernel.kernelCount();
    else
        count = kernel.bundlesOfPhase();
    instruments::beginLaunch(&countOf<Kernel>, binding);
    return count;
}

template <class Kernel>
void run(const Binding& binding, uint begin, uint end) {
    if (begin != 0) throw std::logic_error("a device of one thread runs a launch at once");
    constexpr bool ofGroups = requires(Kernel kernel) {
        kernel.main();
    };
    constexpr uint count = ofGroups ? instruments::groupThreads : 1;
    auto* const kernels = static_cast<Kernel*>(instruments::roomForKernels(count * sizeof(Kernel)));
    for (uint thread = 0; thread < count; ++thread) new (kernels + thread) Kernel(binding);
    instruments::Body body{.kernels = kernels, .coherentSlots = kernels->coherentSlots};
    if constexpr (ofGroups) {
        body.call = [](void* objects, uint thread, uint number) {
            Kernel& kernel = static_cast<Kernel*>(objects)[thread];
            kernel.thread = thread;
            kernel.gl_WorkGroupID.x = number;
            kernel.main();
        };
        instruments::runGroups(end, body);
    } else {
        body.call = [](void* object, uint thread, uint number) {
            Kernel& kernel = *static_cast<Kernel*>(object);
            kernel.thread = thread;
            kernel.kernelBody(number);
        };
        instruments::runInvocations(end, body);
    }
}

}  // namespace spherule::compute::cpu::SPHERULE_PRECISION

#undef BUFFER
#define BUFFER(access, type, name) \
    SPHERULE_ACCESS_##access(type) name = slot<type>(access##Slot(placeAmong(declared, #name)));
#undef PREFETCH
#define PREFETCH(element) static_cast<void>(sizeof(element));
#undef THREAD
#define THREAD thread
#undef THREADS
#define THREADS instruments::groupThreads
#undef FIRST_THREAD
#define FIRST_THREAD (thread == 0U)
#undef SHARED
#define shared __attribute__((section("work_group_memory"))) inline static
#define SHARED(type, name) shared type name;
#undef BARRIER
#define BARRIER instruments::barrier(false, __LINE__);
#undef BUFFER_BARRIER
#define BUFFER_BARRIER instruments::barrier(true, __LINE__);
#undef BUNDLE_KERNEL
#define BUNDLE_KERNEL(count)          \
    void main() {                     \
        kernelBody(gl_WorkGroupID.x); \
    }                                 \
    KERNEL(count)
#undef LANE_BUNDLE_KERNEL
#define LANE_BUNDLE_KERNEL(count) BUNDLE_KERNEL(count)
#define THREADS_OF_GROUP(count)
#define PAIR_THREADS instruments::groupThreads
#undef PAIR_KERNEL
#include "pair_kernel.h"

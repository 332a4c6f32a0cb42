#pragma once

#include <cstdint>
#include <span>

#include "compute/device.h"

// The kernels of shaders/, compiled as C++.
namespace spherule::compute::cpu {

// One launch. A slot that the scene's features leave unused may be null.
struct Binding {
    std::span<void* const> slots;      // by the index of the declaration
    const void* parameters = nullptr;  // null for kernels without them
    std::uint32_t phase = 0;
    std::uint64_t features = 0;  // bits of Features
};

struct Entry {
    const char* name;  // file
    std::span<const BufferDeclaration> buffers;
    bool wantsParameters;
    std::uint32_t (*count)(const Binding&);  // invocations
    std::uint32_t smallestRange;             // ranges are multiples of it, except the last
    // Runs invocations begin .. end - 1. Any number of threads may call it, each with its own range.
    void (*run)(const Binding&, std::uint32_t begin, std::uint32_t end);
};

// The kernels with `float` as on GPUs, and the kernels with `double` in its place: in arithmetic, buffers and
// parameters.
std::span<const Entry> floatKernels();
std::span<const Entry> doubleKernels();

// The float kernels that have lanes, with 4, 8 or 16 lanes. They give the same bits as the kernels with one lane.
std::span<const Entry> kernelsWith4Lanes();
std::span<const Entry> kernelsWith8Lanes();
std::span<const Entry> kernelsWith16Lanes();

}  // namespace spherule::compute::cpu

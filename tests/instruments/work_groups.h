// Runs the invocations of launches one after the other, in an order that a GPU could choose. A work group has 64
// threads: between two barriers, each runs in turn on a stack of its own.
//
// Only one thread of the program may run kernels: devices are "cpu:1x1".
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compute/cpu/kernels.h"

namespace spherule::instruments {

constexpr std::uint32_t groupThreads = 64;

using compute::cpu::Entry;

// The kernels that devices opened from now on use. The default is production(). The table must outlive the devices.
void useKernels(std::span<const Entry> table);
std::span<const Entry> production();  // as in the program
std::span<const Entry> inWorkGroups();
// Kernels with a planted fault; not part of the program.
std::span<const Entry> controls();

// Returns the kernel of a table. Throws std::out_of_range if there is none.
const Entry& kernelOf(std::span<const Entry> table, std::string_view file);

// Sets the order of the invocations of inWorkGroups(). 0: by their numbers. Any other seed: another permutation of
// work groups in each launch, and of threads between two barriers.
void setOrder(std::uint64_t seed);

// Chooses kernels and their order for its life, and production() afterwards.
class Chosen {
  public:
    explicit Chosen(std::span<const Entry> table, std::uint64_t seed = 0) {
        useKernels(table);
        setOrder(seed);
    }
    ~Chosen() {
        useKernels(production());
        setOrder(0);
    }
    Chosen(const Chosen&) = delete;
    Chosen& operator=(const Chosen&) = delete;
};

// Returns the number of launches of a kernel by its file name, since the program began.
std::uint64_t launchesOf(std::string_view file);
std::uint64_t launches();
// Returns the kernels of inWorkGroups() that were never launched.
std::vector<std::string> neverLaunched();

// Returns the faults in the use of barriers since the last call, each a sentence. Threads of a work group wait at
// different barriers, or some have ended while others wait.
std::vector<std::string> takeBarrierFaults();

// The invocation at work.
struct Place {
    bool running = false;             // in a kernel
    bool inGroup = false;             // of a work group
    std::uint32_t launch = 0;         // counts launches
    std::uint32_t user = 0;           // counts the work groups, or the invocations without work groups, of the launch
    std::uint32_t thread = 0;         // of the work group
    std::uint32_t interval = 0;       // counts the barriers of the work group
    std::uint32_t coherentSlots = 0;  // one bit for each buffer of the kernel
};
const Place& place();
// Returns the number of an invocation or a work group, for Place::user of the present launch.
std::uint32_t numberOf(std::uint32_t user);
// Returns the count of those barriers before an interval of the present work group that order accesses to buffers.
std::uint32_t bufferBarriersBefore(std::uint32_t interval);
const Entry& kernelAtWork();
std::span<void* const> slotsAtWork();

struct AddressRange {
    std::uintptr_t begin = 0;
    std::uintptr_t end = 0;
    [[nodiscard]] bool contains(std::uintptr_t address) const { return address >= begin && address < end; }
};
// The stacks and the objects of kernels: memory that no two invocations share.
AddressRange privateMemory();
// The variables of a work group (SHARED).
AddressRange sharedMemory();

// The following is for work_group_kernels.cpp.

// Begins a launch of the kernel of inWorkGroups() or controls() with this function Entry::count.
void beginLaunch(std::uint32_t (*kernel)(const compute::cpu::Binding&), const compute::cpu::Binding& binding);

// Room for the objects of one kernel, one for each thread.
void* roomForKernels(std::size_t bytes);

// Calls `call(kernels, thread, number)` for the numbers below `count`, in the order of the launch: once, or once for
// each thread of a work group. `count`: at most what Entry::count gives.
struct Body {
    void* kernels = nullptr;
    void (*call)(void* kernels, std::uint32_t thread, std::uint32_t number) = nullptr;
    std::uint32_t coherentSlots = 0;
};
void runInvocations(std::uint32_t count, const Body& body);
void runGroups(std::uint32_t count, const Body& body);

// Waits for all threads of the work group. `buffers`: it also orders accesses to coherent buffers. `line`: of the
// source.
void barrier(bool buffers, int line);

}  // namespace spherule::instruments

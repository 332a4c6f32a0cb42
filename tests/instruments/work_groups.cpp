#include "work_groups.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <numeric>
#include <stdexcept>
#include <thread>

#include <sys/mman.h>

#include "threads.h"

// The linker option --wrap redirects the device's calls of floatKernels() to the first of these functions. The second
// one is floatKernels() itself.
std::span<const spherule::compute::cpu::Entry> chosenKernels() __asm__(
    "__wrap__ZN8spherule7compute3cpu12floatKernelsEv");
std::span<const spherule::compute::cpu::Entry> productionKernels() __asm__(
    "__real__ZN8spherule7compute3cpu12floatKernelsEv");

// The section of the variables of work groups.
extern "C" {
extern std::byte __start_work_group_memory[];
extern std::byte __stop_work_group_memory[];
}

namespace spherule::instruments {

static_assert(Threads::count == groupThreads);

namespace {

constexpr std::size_t roomBytes = std::size_t{1} << 20U;
constexpr std::size_t privateBytes = Threads::count * Threads::stackBytes + roomBytes;

std::byte* allocatePrivateMemory() {
    void* const memory =
        mmap(nullptr, privateBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    return static_cast<std::byte*>(memory);
}

std::uint64_t mixed(std::uint64_t x) {
    x ^= x >> 30U;
    x *= 0xbf58476d1ce4e5b9U;
    x ^= x >> 27U;
    x *= 0x94d049bb133111ebU;
    return x ^ (x >> 31U);
}

// k -> (k * factor + shift) mod count
struct Permutation {
    std::uint64_t count = 1;
    std::uint64_t factor = 1;
    std::uint64_t shift = 0;

    Permutation(std::uint64_t numbers, std::uint64_t random) : count(numbers) {
        if (random == 0 || count < 2) return;
        factor = 1 + random % (count - 1);
        while (std::gcd(factor, count) != 1) factor = factor % (count - 1) + 1;
        shift = (random >> 32U) % count;
    }
    [[nodiscard]] std::uint32_t operator()(std::uint64_t k) const {
        return static_cast<std::uint32_t>((k * factor + shift) % count);
    }
};

struct State {
    std::span<const Entry> table = productionKernels();
    std::uint64_t seed = 0;
    Place place;
    std::uint32_t (*kernel)(const compute::cpu::Binding&) = nullptr;
    std::vector<void*> slots;
    std::vector<std::uint32_t> numbers;         // by user
    std::vector<std::uint32_t> bufferBarriers;  // by interval
    std::array<int, groupThreads> lines{};      // of the barrier at which a thread waits
    std::vector<std::string> faults;
    std::map<std::uint32_t (*)(const compute::cpu::Binding&), std::uint64_t> launches;
    std::byte* memory = allocatePrivateMemory();
    Threads threads{memory};
    std::thread::id owner = std::this_thread::get_id();
    bool waitsForBuffers = false;
};

State& state() {
    static State only;
    return only;
}

// Returns 0 for the order by numbers.
std::uint64_t randomOf(std::uint64_t of) {
    return state().seed == 0 ? 0 : mixed(mixed(state().seed + 0x9e3779b97f4a7c15U * state().place.launch) + of) | 1U;
}

void beginUser(std::uint32_t number) {
    State& now = state();
    now.place.user = static_cast<std::uint32_t>(now.numbers.size());
    now.numbers.push_back(number);
}

void reportFault(const std::string& what) {
    state().faults.push_back(std::string(kernelAtWork().name) + ": " + what);
}

// Tells whether all threads wait at one barrier, or all have ended.
void checkBarrier() {
    const State& now = state();
    std::uint32_t ended = 0;
    std::uint32_t waiting = groupThreads;
    for (std::uint32_t thread = 0; thread < groupThreads; ++thread) {
        if (now.threads.ended(thread))
            ++ended;
        else if (waiting == groupThreads)
            waiting = thread;
        else if (now.lines[thread] != now.lines[waiting])
            reportFault("thread " + std::to_string(waiting) + " waits in line " + std::to_string(now.lines[waiting]) +
                        ", thread " + std::to_string(thread) + " in line " + std::to_string(now.lines[thread]));
    }
    if (ended > 0 && waiting < groupThreads)
        reportFault(std::to_string(ended) + " threads ended, thread " + std::to_string(waiting) + " waits in line " +
                    std::to_string(now.lines[waiting]));
}

struct GroupWork {
    const Body& body;
    std::uint32_t number;
};

void runGroup(const Body& body, std::uint32_t number) {
    State& now = state();
    std::memset(__start_work_group_memory, 0xff,
                static_cast<std::size_t>(__stop_work_group_memory - __start_work_group_memory));
    const GroupWork work{body, number};
    now.threads.begin(
        [](const void* context, std::uint32_t thread) {
            const auto& [ofGroup, group] = *static_cast<const GroupWork*>(context);
            ofGroup.call(ofGroup.kernels, thread, group);
        },
        &work);
    now.bufferBarriers.assign(1, 0);
    for (now.place.interval = 0;; ++now.place.interval) {
        const Permutation order(groupThreads,
                                randomOf((std::uint64_t{now.place.user} << 32U) + now.place.interval + 1));
        now.waitsForBuffers = false;
        bool left = false;
        for (std::uint32_t k = 0; k < groupThreads; ++k) {
            now.place.thread = order(k);
            if (now.threads.ended(now.place.thread)) continue;
            now.place.running = true;
            now.threads.resume(now.place.thread);
            now.place.running = false;
            left = left || !now.threads.ended(now.place.thread);
        }
        if (!left) return;
        checkBarrier();
        now.bufferBarriers.push_back(now.bufferBarriers.back() + (now.waitsForBuffers ? 1 : 0));
    }
}

}  // namespace

void useKernels(std::span<const Entry> table) {
    state().table = table;
}

std::span<const Entry> production() {
    return productionKernels();
}

const Entry& kernelOf(std::span<const Entry> table, std::string_view file) {
    const auto found = std::ranges::find(table, file, &Entry::name);
    if (found == table.end()) throw std::out_of_range(std::string(file));
    return *found;
}

void setOrder(std::uint64_t seed) {
    state().seed = seed;
}

std::uint64_t launchesOf(std::string_view file) {
    const auto& counts = state().launches;
    const auto found = counts.find(kernelOf(inWorkGroups(), file).count);
    return found == counts.end() ? 0 : found->second;
}

std::uint64_t launches() {
    return state().place.launch;
}

std::vector<std::string> neverLaunched() {
    std::vector<std::string> names;
    for (const Entry& entry : inWorkGroups())
        if (launchesOf(entry.name) == 0) names.emplace_back(entry.name);
    return names;
}

std::vector<std::string> takeBarrierFaults() {
    return std::exchange(state().faults, {});
}

const Place& place() {
    return state().place;
}

std::uint32_t numberOf(std::uint32_t user) {
    return state().numbers[user];
}

std::uint32_t bufferBarriersBefore(std::uint32_t interval) {
    return state().bufferBarriers[interval];
}

const Entry& kernelAtWork() {
    for (const auto& table : {inWorkGroups(), controls()}) {
        const auto found = std::ranges::find(table, state().kernel, &Entry::count);
        if (found != table.end()) return *found;
    }
    throw std::logic_error("no kernel is at work");
}

std::span<void* const> slotsAtWork() {
    return state().slots;
}

AddressRange privateMemory() {
    const auto begin = reinterpret_cast<std::uintptr_t>(state().memory);
    return {begin, begin + privateBytes};
}

AddressRange sharedMemory() {
    return {reinterpret_cast<std::uintptr_t>(__start_work_group_memory),
            reinterpret_cast<std::uintptr_t>(__stop_work_group_memory)};
}

void beginLaunch(std::uint32_t (*kernel)(const compute::cpu::Binding&), const compute::cpu::Binding& binding) {
    State& now = state();
    if (std::this_thread::get_id() != now.owner) throw std::logic_error("only one thread may run kernels");
    ++now.place.launch;
    ++now.launches[kernel];
    now.kernel = kernel;
    now.slots.assign(binding.slots.begin(), binding.slots.end());
    now.numbers.clear();
}

void* roomForKernels(std::size_t bytes) {
    if (bytes > roomBytes) throw std::bad_alloc();
    return state().memory + Threads::count * Threads::stackBytes;
}

void runInvocations(std::uint32_t count, const Body& body) {
    State& now = state();
    now.place.inGroup = false;
    now.place.coherentSlots = body.coherentSlots;
    const Permutation order(count, randomOf(0));
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t number = order(k);
        beginUser(number);
        now.place.thread = number % groupThreads;
        now.place.running = true;
        body.call(body.kernels, now.place.thread, number);
        now.place.running = false;
    }
}

void runGroups(std::uint32_t count, const Body& body) {
    State& now = state();
    now.place.inGroup = true;
    now.place.coherentSlots = body.coherentSlots;
    const Permutation order(count, randomOf(0));
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t number = order(k);
        beginUser(number);
        runGroup(body, number);
    }
}

void barrier(bool buffers, int line) {
    State& now = state();
    now.place.running = false;
    now.waitsForBuffers = now.waitsForBuffers || buffers;
    now.lines[now.place.thread] = line;
    now.threads.wait();
    now.place.running = true;
}

}  // namespace spherule::instruments

std::span<const spherule::compute::cpu::Entry> chosenKernels() {
    return spherule::instruments::state().table;
}

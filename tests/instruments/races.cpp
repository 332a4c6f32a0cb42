#include "races.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <pthread.h>
#include <spdlog/fmt/fmt.h>

#include "work_groups.h"

namespace spherule::instruments {
namespace {

enum class Access : std::uint8_t { Read, Write, AtomicRead, AtomicWrite };
constexpr std::array<const char*, 4> accessNames{"read", "write", "atomic read", "atomic write"};

constexpr bool compatible(Access a, Access b) {
    const auto writes = [](Access access) { return access == Access::Write || access == Access::AtomicWrite; };
    const auto atomic = [](Access access) { return access == Access::AtomicRead || access == Access::AtomicWrite; };
    return (!writes(a) && !writes(b)) || (atomic(a) && atomic(b));
}

// The users of a word by the kind of access: the last two of each kind.
template <class Number>
struct Users {
    static constexpr Number none = static_cast<Number>(-1);

    std::array<Number, 4> last{none, none, none, none};
    std::array<Number, 4> before{none, none, none, none};  // others than the last

    // Notes an access. Returns the kind of an earlier access that races with it, and sets `other`; 4: there is none.
    unsigned note(Access access, Number who, Number& other) {
        unsigned found = 4;
        for (unsigned kind = 0; kind < 4; ++kind) {
            if (last[kind] == none || compatible(access, static_cast<Access>(kind))) continue;
            const Number user = last[kind] == who ? before[kind] : last[kind];
            if (user == none) continue;
            found = kind;
            other = user;
        }
        const auto self = static_cast<unsigned>(access);
        if (last[self] != who) {
            before[self] = last[self];
            last[self] = who;
        }
        return found;
    }
};

// The users of a word in the launch under way.
struct Word {
    std::uint32_t launch = 0;
    std::uint32_t group = 0;     // of `threads`: a Place::user
    std::uint32_t interval = 0;  // of `threads`
    bool fetched = false;        // read before it was written
    bool written = false;
    Users<std::uint32_t> groups;
    Users<std::uint8_t> threads;
};

constexpr std::size_t pageBits = 14;  // of addresses
constexpr std::size_t pageWords = (std::size_t{1} << pageBits) / 4;
using Page = std::array<Word, pageWords>;

AddressRange stackOfProgram() {
    pthread_attr_t attributes;
    void* base = nullptr;
    std::size_t bytes = 0;
    pthread_getattr_np(pthread_self(), &attributes);
    pthread_attr_getstack(&attributes, &base, &bytes);
    pthread_attr_destroy(&attributes);
    const auto begin = reinterpret_cast<std::uintptr_t>(base);
    return {begin, begin + bytes};
}

struct Detector {
    std::unordered_map<std::uintptr_t, std::unique_ptr<Page>> pages;
    std::array<std::pair<std::uintptr_t, Page*>, 256> recent{};  // pages by the low bits of their numbers
    AddressRange stack = stackOfProgram();
    AddressRange ofInvocations = privateMemory();
    AddressRange ofGroups = sharedMemory();
    std::map<std::tuple<std::string, std::string, std::string>, Race> races;
    std::map<std::pair<const Entry*, std::size_t>, Traffic> traffic;  // by kernel and slot
    std::array<Traffic*, compute::maxKernelBuffers> ofLaunch{};       // of the launch under way, by slot
    std::uint32_t launch = 0;                                         // that launch
    std::uint64_t accesses = 0;

    Word& wordAt(std::uintptr_t address) {
        const std::uintptr_t number = address >> pageBits;
        auto& [cached, page] = recent[number % recent.size()];
        if (cached != number || page == nullptr) {
            std::unique_ptr<Page>& owner = pages[number];
            if (!owner) owner = std::make_unique<Page>();
            cached = number;
            page = owner.get();
        }
        return (*page)[(address & ((std::uintptr_t{1} << pageBits) - 1)) / 4];
    }
};

Detector& detector() {
    static Detector only;
    return only;
}

constexpr std::size_t noSlot = ~std::size_t{0};

// Buffers lie apart, so the one with the highest address below the word has it.
std::size_t slotOf(std::uintptr_t address) {
    std::size_t found = noSlot;
    std::uintptr_t nearest = 0;
    const auto slots = slotsAtWork();
    for (std::size_t slot = 0; slot < slots.size(); ++slot) {
        const auto begin = reinterpret_cast<std::uintptr_t>(slots[slot]);
        if (begin == 0 || begin > address || begin <= nearest) continue;
        nearest = begin;
        found = slot;
    }
    return found;
}

// Tells whether the barriers since the last access of the work group to the word order the accesses.
bool orderedByBarriers(const Word& word, std::uintptr_t address) {
    if (detector().ofGroups.contains(address)) return true;
    const std::size_t slot = slotOf(address);
    if (slot == noSlot || (place().coherentSlots >> slot & 1U) == 0) return false;
    return bufferBarriersBefore(word.interval) != bufferBarriersBefore(place().interval);
}

void report(std::uintptr_t address, const std::string& kind, bool inGroup, std::uint32_t first, std::uint32_t second) {
    const Entry& kernel = kernelAtWork();
    const bool shared = detector().ofGroups.contains(address);
    const std::size_t slot = shared ? noSlot : slotOf(address);
    const std::string buffer(slot == noSlot ? "" : kernel.buffers[slot].name);
    Race& race = detector().races[{kernel.name, buffer, kind}];
    if (race.count++ > 0) return;
    std::uintptr_t begin = detector().ofGroups.begin;
    if (slot != noSlot) begin = reinterpret_cast<std::uintptr_t>(slotsAtWork()[slot]);
    race = {.kernel = kernel.name,
            .buffer = buffer,
            .kind = kind,
            .inGroup = inGroup,
            .first = first,
            .second = second,
            .group = numberOf(place().user),
            .word = (address - begin) / 4,
            .count = 1};
}

std::string kindOf(unsigned before, Access now) {
    return fmt::format("{}, {}", accessNames[before], accessNames[static_cast<unsigned>(now)]);
}

void noteInGroup(Word& word, std::uintptr_t address, Access access, bool anew) {
    const Place& now = place();
    if (anew || word.group != now.user || (word.interval != now.interval && orderedByBarriers(word, address)))
        word.threads = {};
    word.group = now.user;
    word.interval = now.interval;
    std::uint8_t other = 0;
    const unsigned before = word.threads.note(access, static_cast<std::uint8_t>(now.thread), other);
    if (before < 4) report(address, kindOf(before, access), true, other, now.thread);
}

constexpr std::size_t sectorWords = 8;

// Notes that the launch needs the content of a word, or changes it, for the first time.
void noteTraffic(Word& word, std::uintptr_t address, bool write) {
    const std::size_t slot = slotOf(address);
    if (slot == noSlot) return;
    const std::uint32_t launch = place().launch;
    const Word* const sector = &word - address / 4 % sectorWords;
    const bool moved = std::any_of(sector, sector + sectorWords, [&](const Word& other) {
        return other.launch == launch && (write ? other.written : other.fetched);
    });
    (write ? word.written : word.fetched) = true;
    if (std::exchange(detector().launch, launch) != launch) detector().ofLaunch.fill(nullptr);
    Traffic*& known = detector().ofLaunch[slot];
    if (known == nullptr) known = &detector().traffic[{&kernelAtWork(), slot}];
    Traffic& traffic = *known;
    (write ? traffic.bytesWritten : traffic.bytesRead) += 4;
    if (!moved) (write ? traffic.sectorBytesWritten : traffic.sectorBytesRead) += 4 * sectorWords;
}

void noteWord(std::uintptr_t address, Access access) {
    const Place& now = place();
    Word& word = detector().wordAt(address);
    const bool anew = word.launch != now.launch;
    if (detector().ofGroups.contains(address)) {
        if (access == Access::Read && (anew || word.group != now.user))
            report(address, "read, never written", true, now.thread, now.thread);
        word.launch = now.launch;
        noteInGroup(word, address, access, anew);
        return;
    }
    if (anew) {
        word.groups = {};
        word.fetched = word.written = false;
    }
    word.launch = now.launch;
    const bool writes = access == Access::Write || access == Access::AtomicWrite;
    if (access != Access::Write && !word.fetched && !word.written) noteTraffic(word, address, false);
    if (writes && !word.written) noteTraffic(word, address, true);
    std::uint32_t other = 0;
    const unsigned before = word.groups.note(access, now.user, other);
    if (before < 4) report(address, kindOf(before, access), false, numberOf(other), numberOf(now.user));
    if (now.inGroup) noteInGroup(word, address, access, anew);
}

void note(const volatile void* pointer, std::size_t bytes, Access access) {
    if (!place().running) return;
    const auto address = reinterpret_cast<std::uintptr_t>(pointer);
    Detector& now = detector();
    if (now.ofInvocations.contains(address) || now.stack.contains(address)) return;
    ++now.accesses;
    for (std::uintptr_t at = address & ~std::uintptr_t{3}; at < address + bytes; at += 4) noteWord(at, access);
}

}  // namespace

std::string Race::text() const {
    const std::string where =
        buffer.empty() ? "a variable of the work group" : fmt::format("{}[word {}]", buffer, word);
    const std::string who = inGroup ? fmt::format("threads {} and {} of work group {}", first, second, group)
                                    : fmt::format("invocations {} and {}", first, second);
    return fmt::format("{}: {} of {} by {}, {} times", kernel, kind, where, who, count);
}

std::vector<Race> takeRaces() {
    std::vector<Race> found;
    for (auto& [key, race] : detector().races) found.push_back(std::move(race));
    detector().races.clear();
    return found;
}

std::vector<Traffic> takeTraffic() {
    std::vector<Traffic> found;
    for (auto& [key, traffic] : detector().traffic) {
        traffic.kernel = key.first->name;
        traffic.buffer = key.first->buffers[key.second].name;
        found.push_back(std::move(traffic));
    }
    detector().traffic.clear();
    detector().ofLaunch.fill(nullptr);
    return found;
}

std::uint64_t accesses() {
    return detector().accesses;
}

}  // namespace spherule::instruments

// The hooks that GCC and Clang insert. The runtime of -fsanitize=thread has the same functions.
// NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp)
using spherule::instruments::Access;
using spherule::instruments::note;
using Atomic = volatile std::uint32_t;

#define SPHERULE_ACCESSES(bytes)                   \
    void __tsan_read##bytes(void* at) {            \
        note(at, bytes, Access::Read);             \
    }                                              \
    void __tsan_write##bytes(void* at) {           \
        note(at, bytes, Access::Write);            \
    }                                              \
    void __tsan_unaligned_read##bytes(void* at) {  \
        note(at, bytes, Access::Read);             \
    }                                              \
    void __tsan_unaligned_write##bytes(void* at) { \
        note(at, bytes, Access::Write);            \
    }                                              \
    void __tsan_volatile_read##bytes(void* at) {   \
        note(at, bytes, Access::Read);             \
    }                                              \
    void __tsan_volatile_write##bytes(void* at) {  \
        note(at, bytes, Access::Write);            \
    }

extern "C" {
void __tsan_init() {}
void __tsan_func_entry(void* /*caller*/) {}
void __tsan_func_exit() {}
void __tsan_vptr_read(void** /*at*/) {}
void __tsan_vptr_update(void** /*at*/, void* /*to*/) {}
SPHERULE_ACCESSES(1)
SPHERULE_ACCESSES(2)
SPHERULE_ACCESSES(4)
SPHERULE_ACCESSES(8)
SPHERULE_ACCESSES(16)
void __tsan_read_range(void* at, unsigned long bytes) {
    note(at, bytes, Access::Read);
}
void __tsan_write_range(void* at, unsigned long bytes) {
    note(at, bytes, Access::Write);
}
std::uint32_t __tsan_atomic32_load(const Atomic* at, int /*order*/) {
    note(at, 4, Access::AtomicRead);
    return *at;
}
void __tsan_atomic32_store(Atomic* at, std::uint32_t value, int /*order*/) {
    note(at, 4, Access::AtomicWrite);
    *at = value;
}
std::uint32_t __tsan_atomic32_exchange(Atomic* at, std::uint32_t value, int /*order*/) {
    note(at, 4, Access::AtomicWrite);
    return __atomic_exchange_n(at, value, __ATOMIC_RELAXED);
}
std::uint32_t __tsan_atomic32_fetch_add(Atomic* at, std::uint32_t value, int /*order*/) {
    note(at, 4, Access::AtomicWrite);
    return __atomic_fetch_add(at, value, __ATOMIC_RELAXED);
}
std::uint32_t __tsan_atomic32_fetch_or(Atomic* at, std::uint32_t value, int /*order*/) {
    note(at, 4, Access::AtomicWrite);
    return __atomic_fetch_or(at, value, __ATOMIC_RELAXED);
}
int __tsan_atomic32_compare_exchange_weak(Atomic* at, std::uint32_t* seen, std::uint32_t value, int /*done*/,
                                          int /*failed*/) {
    note(at, 4, Access::AtomicWrite);
    return static_cast<int>(__atomic_compare_exchange_n(at, seen, value, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED));
}
std::uint32_t __tsan_atomic32_compare_exchange_val(Atomic* at, std::uint32_t seen, std::uint32_t value, int /*done*/,
                                                   int /*failed*/) {
    note(at, 4, Access::AtomicWrite);
    __atomic_compare_exchange_n(at, &seen, value, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
    return seen;
}
void* __tsan_memcpy(void* to, const void* from, unsigned long bytes) {
    note(from, bytes, Access::Read);
    note(to, bytes, Access::Write);
    return std::memcpy(to, from, bytes);
}
void* __tsan_memset(void* to, int value, unsigned long bytes) {
    note(to, bytes, Access::Write);
    return std::memset(to, value, bytes);
}
void* __tsan_memmove(void* to, const void* from, unsigned long bytes) {
    note(from, bytes, Access::Read);
    note(to, bytes, Access::Write);
    return std::memmove(to, from, bytes);
}
}
// NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp)

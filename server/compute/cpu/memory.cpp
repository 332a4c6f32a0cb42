#include "compute/cpu/memory.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include <sys/mman.h>

#include <spdlog/fmt/fmt.h>

#include "core/memory.h"

namespace spherule::compute::cpu {
namespace {

constexpr std::size_t lineBytes = 64;
constexpr std::size_t hugePageBytes = std::size_t{2} << 20U;
constexpr std::size_t word = 4;

}  // namespace

Words::Words(std::string_view pattern, Precision precision)
    : pattern_(pattern), asOnTheHost_(precision == Precision::Single || pattern.find('r') == std::string_view::npos) {
    std::size_t place = 0;
    for (const char kind : pattern_) {
        places_.push_back(place);
        place += !asOnTheHost_ && kind == 'r' ? sizeof(double) : word;
    }
    places_.push_back(place);
}

bool Words::wide(std::size_t number) const {
    return pattern_[number % pattern_.size()] == 'r';
}

std::size_t Words::placeOf(std::size_t number) const {
    return number / pattern_.size() * places_.back() + places_[number % pattern_.size()];
}

void Words::store(std::byte* memory, std::size_t hostOffset, std::span<const std::byte> host) const {
    if (asOnTheHost_) {
        std::memcpy(memory + hostOffset, host.data(), host.size());
        return;
    }
    for (std::size_t k = 0; k < host.size() / word; ++k) {
        const std::size_t number = hostOffset / word + k;
        std::byte* const to = memory + placeOf(number);
        if (wide(number)) {
            float narrow = 0;
            std::memcpy(&narrow, &host[k * word], sizeof narrow);
            const auto value = static_cast<double>(narrow);
            std::memcpy(to, &value, sizeof value);
        } else {
            std::memcpy(to, &host[k * word], word);
        }
    }
}

void Words::load(const std::byte* memory, std::size_t hostOffset, std::span<std::byte> host) const {
    if (asOnTheHost_) {
        std::memcpy(host.data(), memory + hostOffset, host.size());
        return;
    }
    for (std::size_t k = 0; k < host.size() / word; ++k) {
        const std::size_t number = hostOffset / word + k;
        const std::byte* const from = memory + placeOf(number);
        if (wide(number)) {
            double value = 0;
            std::memcpy(&value, from, sizeof value);
            const auto narrow = static_cast<float>(value);
            std::memcpy(&host[k * word], &narrow, sizeof narrow);
        } else {
            std::memcpy(&host[k * word], from, word);
        }
    }
}

Result<std::unique_ptr<Buffer>> CpuBuffer::create(std::string_view label, std::size_t bytes, Words words) {
    const std::size_t size = words.bytesFor((bytes + word - 1) / word * word);
    const bool large = size >= hugePageBytes;
    void* data = nullptr;
    // Linux grants more memory than there is, and kills a process that uses it. This check ignores promised memory,
    // because the maker of the plan already holds a claim for this buffer.
    const memory::Room room = memory::room();
    if (size > room.left ||
        posix_memalign(&data, large ? hugePageBytes : lineBytes, std::max<std::size_t>(size, 1)) != 0) {
        return fail(ErrorKind::Refused, std::string(label),
                    fmt::format("needs {} of memory, of which at most {} are left for this program; use fewer spheres, "
                                "or give it more",
                                memory::sizeText(size), memory::sizeText(room.left)),
                    Cause::NoMemory);
    }
    // Kernels read few words at many places. With huge pages the processor seldom looks up a page that it has not used
    // lately. The system may refuse, and then the pages are small.
    if (large) madvise(data, size / hugePageBytes * hugePageBytes, MADV_HUGEPAGE);
    std::memset(data, 0, size);
    return std::unique_ptr<Buffer>(new CpuBuffer(bytes, std::move(words), static_cast<std::byte*>(data)));
}

void CpuBuffer::Free::operator()(std::byte* data) const {
    std::free(data);
}

}  // namespace spherule::compute::cpu

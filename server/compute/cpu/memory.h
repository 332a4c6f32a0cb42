#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "compute/device.h"

namespace spherule::compute::cpu {

enum class Precision : std::uint8_t { Single, Double };

// The memory layout of a buffer's words: as on the host, or, in double precision, with eight bytes per real number.
class Words {
  public:
    // `pattern`: `words` of Device::createBuffer.
    Words(std::string_view pattern, Precision precision);

    [[nodiscard]] std::size_t bytesFor(std::size_t hostBytes) const { return placeOf(hostBytes / 4); }
    void store(std::byte* memory, std::size_t hostOffset, std::span<const std::byte> host) const;
    void load(const std::byte* memory, std::size_t hostOffset, std::span<std::byte> host) const;

  private:
    // For word `number`: its offset (bytes), and true if it is a real number.
    [[nodiscard]] std::size_t placeOf(std::size_t number) const;
    [[nodiscard]] bool wide(std::size_t number) const;

    std::string pattern_;
    std::vector<std::size_t> places_;  // offsets of the pattern's words, then its length (bytes)
    bool asOnTheHost_;
};

// Memory, aligned to cache lines. It has exactly the requested size, so that a sanitizer detects accesses beyond its
// end.
class CpuBuffer final : public Buffer {
  public:
    // Refused if there is not enough memory.
    static Result<std::unique_ptr<Buffer>> create(std::string_view label, std::size_t bytes, Words words);

    [[nodiscard]] std::size_t bytes() const override { return bytes_; }
    [[nodiscard]] std::byte* data() const { return data_.get(); }
    [[nodiscard]] const Words& words() const { return words_; }

  private:
    struct Free {
        void operator()(std::byte* data) const;
    };

    CpuBuffer(std::size_t bytes, Words words, std::byte* data) : bytes_(bytes), words_(std::move(words)), data_(data) {}

    std::size_t bytes_;
    Words words_;
    std::unique_ptr<std::byte, Free> data_;
};

}  // namespace spherule::compute::cpu

#include "codec/block.h"

#include <algorithm>
#include <bit>

namespace spherule::codec {

namespace {

std::uint32_t unitAt(std::span<const std::uint32_t> words, std::size_t unit) {
    return (words[unit / 2] >> (16 * (unit % 2))) & 0xffffU;
}

std::uint32_t wordAt(std::span<const std::uint32_t> words, std::size_t unit) {
    return unitAt(words, unit) | unitAt(words, unit + 1) << 16U;
}

std::uint32_t byteAt(std::span<const std::uint32_t> words, std::size_t byte) {
    return (words[byte / 4] >> (8 * (byte % 4))) & 0xffU;
}

// Units of selectors and base.
std::size_t extraUnits(Mode mode, Predictor predictor) {
    if (mode == Mode::Plain || mode == Mode::Mask) return 0;
    if (mode == Mode::Runs) return 3;
    return predictor == Predictor::None ? 9 : 5;
}

std::uint32_t unzigzag(std::uint32_t value) {
    return (value >> 1U) ^ (0U - (value & 1U));
}

// Returns the number that differs from `value` by a multiple of `turns` and is nearest to 0; `value` if turns is 0.
std::uint32_t nearest(std::uint32_t value, std::uint32_t turns) {
    if (turns == 0) return value;
    const std::int64_t whole = static_cast<std::int32_t>(value);
    const std::int64_t half = turns >> 1U;
    std::int64_t rest = (whole + half) % std::int64_t{turns};
    if (rest < 0) rest += turns;
    return static_cast<std::uint32_t>(rest - half);
}

// Reads consecutive bit fields.
class Bits {
  public:
    Bits(const std::uint32_t* words, std::size_t bit) : words_(words), bit_(bit) {}

    std::uint32_t read(unsigned width) {
        const std::size_t at = bit_ / 32;
        const std::uint64_t both = words_[at] | std::uint64_t{words_[at + 1]} << 32U;
        const std::uint64_t value = (both >> (bit_ % 32)) & ((std::uint64_t{1} << width) - 1);
        bit_ += width;
        return static_cast<std::uint32_t>(value);
    }

  private:
    const std::uint32_t* words_;
    std::size_t bit_;
};

}  // namespace

bool Block::read(std::span<const std::uint32_t> words, std::size_t unit, std::size_t end) {
    if (unit >= end) return false;
    const std::uint32_t header = unitAt(words, unit);
    mode_ = static_cast<Mode>(header & 3U);
    predictor_ = static_cast<Predictor>(header >> 2U & 3U);
    const std::size_t extra = unit + 1;
    const std::size_t values = extra + extraUnits(mode_, predictor_);
    if (values > end) return false;
    values_ = 16 * values;

    const bool runs = mode_ == Mode::Runs || mode_ == Mode::RunsWithBase;
    for (unsigned axis = 0; axis < 3; ++axis) {
        const std::uint32_t code = header >> (4 + 4 * axis) & 15U;
        const std::uint32_t selectors = runs ? unitAt(words, extra + axis) : 0;
        for (unsigned run = 0; run < runsPerAxis; ++run)
            width_[axis][run] = widths[code - std::min(code, selectors >> (2 * run) & 3U)];
    }
    base_ = {};
    if (mode_ == Mode::RunsWithBase) readBase(words, extra + 3);
    if (mode_ == Mode::Mask && !readMask(words, extra, end)) return false;
    end_ = (values_ + valueBits() + 15) / 16;
    return end_ <= end;
}

bool Block::readMask(std::span<const std::uint32_t> words, std::size_t unit, std::size_t end) {
    std::size_t byte = 2 * unit + 3;
    if (byte > 2 * end) return false;
    for (unsigned axis = 0; axis < 3; ++axis) {
        const std::uint32_t there = byteAt(words, 2 * unit + axis);
        for (unsigned run = 0; run < runsPerAxis; ++run) {
            changed_[axis][run] = 0;
            if ((there >> run & 1U) == 0) continue;
            if (byte >= 2 * end) return false;
            changed_[axis][run] = static_cast<std::uint8_t>(byteAt(words, byte++));
        }
    }
    values_ = 8 * byte;
    return true;
}

void Block::readBase(std::span<const std::uint32_t> words, std::size_t unit) {
    if (predictor_ == Predictor::None) {
        for (unsigned axis = 0; axis < 3; ++axis) base_[axis] = wordAt(words, unit + 2 * axis);
        return;
    }
    const std::uint32_t field = wordAt(words, unit);
    for (unsigned axis = 0; axis < 3; ++axis) {
        const std::uint32_t bits = field >> (10 * axis) & 1023U;
        const std::uint32_t wide = bits < 512 ? bits : bits - 1024U;
        base_[axis] = wide << (2 * (field >> 30U));
    }
}

std::size_t Block::valueBits() const {
    std::size_t bits = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
        for (unsigned run = 0; run < runsPerAxis; ++run) {
            const int values = mode_ == Mode::Mask ? std::popcount(changed_[axis][run]) : int{runSpheres};
            bits += static_cast<std::size_t>(values) * width_[axis][run];
        }
    }
    return bits;
}

void Block::readValues(const std::uint32_t* words, std::array<std::uint32_t, blockValues>& values) const {
    Bits bits(words, values_);
    std::uint32_t* to = values.data();
    for (unsigned axis = 0; axis < 3; ++axis) {
        for (unsigned run = 0; run < runsPerAxis; ++run) {
            const unsigned width = width_[axis][run];
            if (mode_ != Mode::Mask) {
                for (unsigned k = 0; k < runSpheres; ++k) *to++ = bits.read(width);
                continue;
            }
            for (unsigned k = 0; k < runSpheres; ++k)
                *to++ = (changed_[axis][run] >> k & 1U) != 0 ? bits.read(width) + 1 : 0;
        }
    }
}

void Block::decode(const std::uint32_t* words, const glm::uvec3& turns, const glm::ivec3* newest,
                   glm::ivec3* before) const {
    std::array<std::uint32_t, blockValues> values;
    readValues(words, values);
    for (int axis = 0; axis < 3; ++axis) {
        const std::uint32_t base = base_[static_cast<unsigned>(axis)];
        for (unsigned k = 0; k < blockSpheres; ++k) {
            const auto q1 = static_cast<std::uint32_t>(newest[k][axis]);
            const std::uint32_t step = nearest(q1 - static_cast<std::uint32_t>(before[k][axis]), turns[axis]);
            std::uint32_t q = unzigzag(values[static_cast<unsigned>(axis) * blockSpheres + k]) + base;
            if (predictor_ != Predictor::None) q += q1;
            if (predictor_ == Predictor::Linear) q += step;
            if (predictor_ == Predictor::Half) q += static_cast<std::uint32_t>(static_cast<std::int32_t>(step) >> 1);
            before[k][axis] = static_cast<std::int32_t>(nearest(q, turns[axis]));
        }
    }
}

}  // namespace spherule::codec

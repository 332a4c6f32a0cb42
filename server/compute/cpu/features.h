#pragma once

#include <cstdint>
#include <string_view>

// The features that kernels test with HAS(): one bit each, in the order of shaders/features.def.
namespace spherule::compute::cpu {

enum class FeatureIndex : std::uint8_t {
#define FEATURE(flag, Name, text) flag,
#include "features.def"
#undef FEATURE
};

struct Features {
    enum Bit : std::uint64_t {
#define FEATURE(flag, Name, text) flag = std::uint64_t{1} << static_cast<unsigned>(FeatureIndex::flag),
#include "features.def"
#undef FEATURE
    };
};

// The names by bit.
constexpr std::string_view featureNames[] = {
#define FEATURE(flag, Name, text) #flag,
#include "features.def"
#undef FEATURE
};

}  // namespace spherule::compute::cpu

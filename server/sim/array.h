#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

// The arrays that a plan may have on the device: the rows of sim/arrays.def.
namespace spherule::sim {

enum class Array : std::uint8_t {
#define ARRAY(Name, type, extent, flags) Name,
#include "sim/arrays.def"
#undef ARRAY
    Count,  // of arrays; none itself
};

constexpr std::size_t arrayCount = static_cast<std::size_t>(Array::Count);

// What an array has one element for. "End": and one more.
enum class Extent : std::uint8_t {
    Sphere,
    SphereEnd,
    WallContact,  // that a sphere remembers
    CellEnd,
    Group,  // of 2 x 2 x 2 cells
    Pair,   // listed; grows, with its content, when the lists need room
    ScanBlock,
    ScanSuperBlock,
    LaunchRow,
    Obstacle,
    MaterialPair,
    Counter,
    StatisticBlock,
};

struct ArrayType {
    std::string name;       // in kernels and in `spherule plan`
    std::string_view type;  // of an element, in kernels
    std::size_t elementBytes = 0;
    std::string words;  // of an element, as compute::Device::createBuffer wants them
    Extent extent{};
    bool sorted = false;   // a column: goes to cell order with the others at a rebuild
    bool cleared = false;  // zeroed when spheres are uploaded
};

const ArrayType& typeOf(Array array);
std::string_view nameOf(Array array);
// The array of that name; nullopt where there is none.
std::optional<Array> arrayNamed(std::string_view name);

}  // namespace spherule::sim

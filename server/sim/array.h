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
    Count,  // number of arrays, not an array
};

constexpr std::size_t arrayCount = static_cast<std::size_t>(Array::Count);

// An array has one element for each of these. "End": one element more.
enum class Extent : std::uint8_t {
    Sphere,           // with movers, and one more that is no sphere: Parameters.farSlot
    SphereAndColour,  // each sphere, once for each colour of bundles
    Entry,            // each sphere, and each mover once more
    PaddedEntry,      // with PAIR_PADDING more at the end
    Mover,            // each sphere that may be a mover
    RememberedWall,   // each wall contact that a sphere remembers
    CellEnd,
    Group,           // of 2 x 2 x 2 cells
    Block,           // of 4 x 4 x 4 cells
    Bundle,          // of blocks
    BundleWord,      // BUNDLE_WORDS for each bundle and once more; then the rows of contact sums, if the scene has them
    Pair,            // each listed pair; the array grows and keeps its content when the lists need room
    PairTwice,       // two halves with an element for each listed pair; grows in the same way
    CarriedContact,  // CARRIED_MOST for each sphere
    ScanBlock,
    ScanSuperBlock,
    LaunchRow,  // two tables of them
    Obstacle,
    ObstacleListWord,
    MaterialPair,
    Counter,
    StatisticBlock,
    PullRow,         // PULL_ROWS for each of MOST_PULLS
    BirthRow,        // BIRTH_CHUNK_ROWS for each chunk of MOST_BIRTH_PLACES
    BirthPlace,      // each of MOST_BIRTH_PLACES
    SurfaceSumWord,  // SURFACE_SUM_WORDS for each copy of each surface
    InspectedWord,   // of one sphere: see layout.h
};

struct ArrayType {
    std::string name;       // in kernels and in `spherule plan`
    std::string_view type;  // of an element, in kernels
    std::size_t elementBytes = 0;
    std::string words;  // of an element, as compute::Device::createBuffer wants them
    Extent extent{};
    bool sorted = false;   // a column: a rebuild sorts it into cell order with the other columns
    bool cleared = false;  // zeroed when spheres are uploaded
    bool byId = false;     // indexed by handle, not by slot
    bool scratch = false;  // between two steps, its content does not matter
};

const ArrayType& typeOf(Array array);
std::string_view nameOf(Array array);
// Returns the array of that name; nullopt if there is none.
std::optional<Array> arrayNamed(std::string_view name);

}  // namespace spherule::sim

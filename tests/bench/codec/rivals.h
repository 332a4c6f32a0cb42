#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace spherule::bench {

// What a codec is given: positions in m, and on the grid now and in the frame before, all in one order.
struct CodecFrame {
    const std::vector<glm::vec3>& metres;
    const std::vector<glm::ivec3>& cells;
    const std::vector<glm::ivec3>& before;
};

// Somebody else's codec.
struct Rival {
    std::string name;
    std::function<std::size_t(const CodecFrame&)> bytes;  // that a frame takes
};

// Those whose libraries were there at build time: zstd, Draco, meshoptimizer.
std::vector<Rival> rivals();

}  // namespace spherule::bench

#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace spherule::bench {

// Input of a codec: positions (m), and grid positions of this and of the previous frame, all in the same order.
struct CodecFrame {
    const std::vector<glm::vec3>& metres;
    const std::vector<glm::ivec3>& cells;
    const std::vector<glm::ivec3>& before;
};

// A codec of another project.
struct Rival {
    std::string name;
    std::function<std::size_t(const CodecFrame&)> bytes;  // size of the encoded frame
};

// The rivals whose libraries existed at build time: zstd, Draco, meshoptimizer.
std::vector<Rival> rivals();

}  // namespace spherule::bench

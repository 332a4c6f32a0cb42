#pragma once

#include <fstream>
#include <iterator>
#include <string>

#include "checkpoint/saved_world.h"
#include "sim/array.h"

namespace spherule::checkpoint {

// A small state with arrays of different sizes. `seed`: another one has other data.
inline SavedWorld exampleWorld(std::uint8_t seed = 1) {
    SavedWorld world;
    world.head.set_scene("example");
    world.head.set_step(120 + seed);
    world.state.host = std::string(3000, static_cast<char>('a' + seed));
    for (const sim::Array array : {sim::Array::Position, sim::Array::Velocity, sim::Array::Counters}) {
        std::vector<std::byte> bytes(static_cast<std::size_t>(array) * 16 + 4096);
        for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<std::byte>((k * k + seed) % 251);
        world.state.arrays.push_back({.array = array, .bytes = std::move(bytes)});
    }
    return world;
}

inline bool sameState(const sim::SavedState& one, const sim::SavedState& other) {
    if (one.host != other.host || one.arrays.size() != other.arrays.size()) return false;
    for (std::size_t k = 0; k < one.arrays.size(); ++k)
        if (one.arrays[k].array != other.arrays[k].array || one.arrays[k].bytes != other.arrays[k].bytes) return false;
    return true;
}

inline std::string contentOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

inline void writeFile(const std::string& path, const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
}

// Returns where each record of a file begins, and its end.
inline std::vector<std::size_t> recordsIn(const std::string& path, FileKind kind) {
    auto reader = RecordReader::open(path, kind);
    std::vector<std::size_t> places{static_cast<std::size_t>(reader->position().bytes)};
    while (reader->next().value()) places.push_back(static_cast<std::size_t>(reader->position().bytes));
    return places;
}

}  // namespace spherule::checkpoint

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// Constants of docs/codec.md.
namespace spherule::codec {

constexpr std::uint32_t blockSpheres = 64;
constexpr std::uint32_t blockValues = 3 * blockSpheres;
constexpr std::uint32_t groupBlocks = 32;
constexpr std::uint32_t chunkGroups = 8;
constexpr std::uint32_t chunkBlocks = groupBlocks * chunkGroups;
constexpr std::uint32_t runSpheres = 8;
constexpr std::uint32_t runsPerAxis = blockSpheres / runSpheres;

constexpr std::size_t headWords = 4;
constexpr std::uint32_t magic = 0x00015053;  // includes the version; the flags are in the highest byte
constexpr std::uint32_t keyframeFlag = 0x01000000;
constexpr std::uint32_t hashedFlag = 0x02000000;
constexpr std::uint32_t turnsFlag = 0x04000000;
constexpr std::size_t turnsHeadWords = 7;  // of a frame with turns
constexpr std::uint32_t mostTurns = 1U << 30U;
constexpr std::uint32_t valueShift = 17;  // bits of a float that the code of a value leaves out
constexpr std::uint32_t spinShift = 19;   // the same for a component of an angular velocity

enum class Mode : std::uint8_t { Plain, Mask, Runs, RunsWithBase };
enum class Predictor : std::uint8_t { Previous, Linear, Half, None };

constexpr std::array<std::uint8_t, 16> widths{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 18, 32};  // by width code

constexpr std::uint32_t blocksFor(std::uint32_t spheres) {
    return spheres / blockSpheres + (spheres % blockSpheres != 0 ? 1 : 0);
}

constexpr std::uint32_t chunksFor(std::uint32_t spheres) {
    return (blocksFor(spheres) + chunkBlocks - 1) / chunkBlocks;
}

}  // namespace spherule::codec

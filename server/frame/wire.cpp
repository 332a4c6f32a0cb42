#include "frame/wire.h"

#include <algorithm>
#include <string>

namespace spherule::frame {

namespace {

constexpr double cellsPerAxis = 65536;
constexpr double lastCell = cellsPerAxis - 1;
constexpr double roomAround = 1.5;      // of the longest side, so that spheres outside an open face still show
constexpr double finestOfRadius = 250;  // a finer grid than r / 250 would cost bits that nobody can see

std::uint32_t readUint16(const std::string& bytes, std::size_t at) {
    const auto low = static_cast<unsigned char>(bytes[at]);
    const auto high = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<std::uint32_t>(low) | (static_cast<std::uint32_t>(high) << 8U);
}

}  // namespace

v1::WireGrid wireGridFor(const scene::Bounds& bounds, double smallestRadius) {
    const glm::dvec3 size = bounds.max - bounds.min;
    const double longest = std::max({size.x, size.y, size.z});
    const double quantum = std::max(smallestRadius / finestOfRadius, roomAround * longest / lastCell);
    // The centre lies on a grid point, so that the device can round positions relative to it without an offset of half
    // a cell.
    const glm::dvec3 origin = bounds.centre() - glm::dvec3(quantum * cellsPerAxis / 2);
    v1::WireGrid grid;
    grid.set_origin_x(origin.x);
    grid.set_origin_y(origin.y);
    grid.set_origin_z(origin.z);
    grid.set_quantum(quantum);
    return grid;
}

std::size_t packedBytes(std::uint32_t count) {
    const std::size_t blocks = (static_cast<std::size_t>(count) + blockSpheres - 1) / blockSpheres;
    return blocks * blockBytes;
}

v1::States statesOf(std::span<const std::byte> packed) {
    v1::States states;
    states.mutable_packed16()->set_positions(packed.data(), packed.size());
    return states;
}

Result<std::vector<glm::dvec3>> positionsOf(const v1::Frame& frame, const v1::WireGrid& grid) {
    if (!frame.states().has_packed16()) {
        return fail(ErrorKind::Input, "frame.states", "is in no codec known here; known: packed16");
    }
    const std::string& bytes = frame.states().packed16().positions();
    if (bytes.size() != packedBytes(frame.count())) {
        return fail(ErrorKind::Input, "frame.states.packed16.positions",
                    "has " + std::to_string(bytes.size()) + " bytes where " + std::to_string(frame.count()) +
                        " spheres take " + std::to_string(packedBytes(frame.count())));
    }
    const glm::dvec3 origin(grid.origin_x(), grid.origin_y(), grid.origin_z());
    std::vector<glm::dvec3> positions(frame.count());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const glm::dvec3 cell(readUint16(bytes, 6 * i), readUint16(bytes, 6 * i + 2), readUint16(bytes, 6 * i + 4));
        positions[i] = origin + grid.quantum() * cell;
    }
    return positions;
}

}  // namespace spherule::frame

#include "rivals.h"

#include <cstdint>
#include <span>

#ifdef SPHERULE_HAS_ZSTD
#include <zstd.h>
#endif
#ifdef SPHERULE_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif
#ifdef SPHERULE_HAS_DRACO
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>
#endif

namespace spherule::bench {

namespace {

constexpr int middle = 1 << 30;  // makes cells unsigned

[[maybe_unused]] std::uint32_t zigzag(int value) {
    return static_cast<std::uint32_t>(value) << 1U ^ static_cast<std::uint32_t>(value >> 31);
}

#ifdef SPHERULE_HAS_ZSTD
std::size_t zstd(std::span<const std::byte> bytes, int level) {
    std::vector<std::byte> out(ZSTD_compressBound(bytes.size()));
    return ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), level);
}

// Changes since the previous frame, byte plane by byte plane.
std::vector<std::byte> planesOf(const CodecFrame& frame) {
    const std::size_t spheres = frame.cells.size();
    std::vector<std::byte> planes(12 * spheres);
    for (std::size_t k = 0; k < spheres; ++k) {
        for (int axis = 0; axis < 3; ++axis) {
            const std::uint32_t value = zigzag(frame.cells[k][axis] - frame.before[k][axis]);
            for (unsigned part = 0; part < 4; ++part)
                planes[(static_cast<unsigned>(axis) * 4 + part) * spheres + k] =
                    static_cast<std::byte>(value >> 8 * part);
        }
    }
    return planes;
}
#endif

#ifdef SPHERULE_HAS_MESHOPTIMIZER
std::size_t meshopt(const void* values, std::size_t spheres) {
    constexpr std::size_t stride = 12;
    std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(spheres, stride));
    return meshopt_encodeVertexBuffer(out.data(), out.size(), values, spheres, stride);
}

std::size_t meshoptChanges(const CodecFrame& frame) {
    std::vector<std::uint32_t> values;
    for (std::size_t k = 0; k < frame.cells.size(); ++k)
        for (int axis = 0; axis < 3; ++axis) values.push_back(zigzag(frame.cells[k][axis] - frame.before[k][axis]));
    return meshopt(values.data(), frame.cells.size());
}
#endif

#ifdef SPHERULE_HAS_DRACO
// Draco does not preserve the order of points.
std::size_t draco(const CodecFrame& frame) {
    std::vector<std::uint32_t> values;
    for (const glm::ivec3& cell : frame.cells)
        for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<std::uint32_t>(cell[axis] + middle));
    ::draco::PointCloudBuilder builder;
    builder.Start(static_cast<std::uint32_t>(frame.cells.size()));
    const int attribute = builder.AddAttribute(::draco::GeometryAttribute::POSITION, 3, ::draco::DT_UINT32);
    builder.SetAttributeValuesForAllPoints(attribute, values.data(), 0);
    const auto cloud = builder.Finalize(false);
    ::draco::Encoder encoder;
    encoder.SetEncodingMethod(::draco::POINT_CLOUD_KD_TREE_ENCODING);
    ::draco::EncoderBuffer out;
    return encoder.EncodePointCloudToBuffer(*cloud, &out).ok() ? out.size() : 0;
}
#endif

}  // namespace

std::vector<Rival> rivals() {
    std::vector<Rival> all;
#ifdef SPHERULE_HAS_ZSTD
    all.push_back(
        {"float32, zstd -3", [](const CodecFrame& f) { return zstd(std::as_bytes(std::span(f.metres)), 3); }});
    all.push_back({"changes, byte planes, zstd -3", [](const CodecFrame& f) { return zstd(planesOf(f), 3); }});
#endif
#ifdef SPHERULE_HAS_MESHOPTIMIZER
    all.push_back({"meshoptimizer", [](const CodecFrame& f) { return meshopt(f.cells.data(), f.cells.size()); }});
    all.push_back({"changes, meshoptimizer", meshoptChanges});
#endif
#ifdef SPHERULE_HAS_DRACO
    all.push_back({"Draco kd-tree", draco});
#endif
    return all;
}

}  // namespace spherule::bench

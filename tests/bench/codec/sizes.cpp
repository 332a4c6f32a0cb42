#include "sizes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "codec/decoder.h"
#include "encode/column_encoder.h"
#include "encode/morton.h"
#include "rivals.h"
#include "value_of.h"

namespace spherule::bench {

namespace {

constexpr std::size_t warmUp = 2;  // frames, until velocities are known

using support::valueOf;

using Order = std::vector<std::uint32_t>;
using Metres = std::vector<glm::vec3>;
using Cells = std::vector<glm::ivec3>;

Cells cellsOf(const Metres& positions, double quantum) {
    const auto inverse = static_cast<float>(1 / quantum);
    Cells cells;
    cells.reserve(positions.size());
    for (const glm::vec3& p : positions)
        cells.emplace_back(std::floor(p.x * inverse + 0.5F), std::floor(p.y * inverse + 0.5F),
                           std::floor(p.z * inverse + 0.5F));
    return cells;
}

template <class T>
std::vector<T> inOrder(const std::vector<T>& values, const Order& order) {
    std::vector<T> sorted(values.size());
    std::ranges::transform(order, sorted.begin(), [&](std::uint32_t id) { return values[id]; });
    return sorted;
}

struct Ours {
    double frame = 0;
    double keyframe = 0;
};

Ours ours(compute::Device& device, const Trajectory& trajectory, double quantum, const Order& order) {
    const std::uint32_t spheres = trajectory.spheres;
    const auto context = valueOf(encode::EncoderContext::create(device, spheres, false));
    const auto frames = valueOf(encode::ColumnEncoder::create(*context, {.quantum = quantum}));
    const auto position = valueOf(device.createBuffer("position", spheres * sizeof(glm::vec4), "r"));
    context->setOrder(order);
    codec::Decoder decoder(spheres);
    std::size_t bytes = 0;
    for (std::size_t k = 0; k < trajectory.frames.size(); ++k) {
        const Metres& metres = trajectory.frames[k];
        std::vector<glm::vec4> positions;
        for (const glm::vec3& p : metres) positions.emplace_back(p, 0);
        device.upload(*position, 0, std::as_bytes(std::span(positions)));
        if (k == 0)
            frames->encodeKeyframe({.values = position.get()});
        else
            frames->encodeDelta({.values = position.get()});
        const auto made = frames->download();
        (void)valueOf(decoder.apply(made));
        if (!std::ranges::equal(decoder.newest(), inOrder(cellsOf(metres, quantum), order)))
            throw std::runtime_error("a decoded frame differs from what was encoded");
        if (k >= warmUp) bytes += made.size();
    }
    frames->encodeResync();
    const std::size_t keyframe = frames->download().size();
    return {.frame = static_cast<double>(bytes) / static_cast<double>(trajectory.frames.size() - warmUp) / spheres,
            .keyframe = static_cast<double>(keyframe) / spheres};
}

}  // namespace

std::vector<CodecSize> codecSizes(compute::Device& device, const Trajectory& trajectory, double ratio) {
    const double quantum = 2 * trajectory.smallestRadius / ratio;
    std::vector<CodecSize> sizes;
    const auto add = [&](const std::string& codec, double bytes) {
        sizes.push_back({.codec = codec, .trajectory = trajectory.name, .ratio = ratio, .bytes = bytes});
    };
    std::vector<glm::vec4> first;
    for (const glm::vec3& p : trajectory.frames.front()) first.emplace_back(p, 0);
    const Order order = encode::mortonOrder(first);
    Order ids(trajectory.spheres);
    std::iota(ids.begin(), ids.end(), 0U);
    const Ours morton = ours(device, trajectory, quantum, order);
    add("SPB, Morton", morton.frame);
    add("SPB, by id", ours(device, trajectory, quantum, ids).frame);
    add("SPB keyframe, Morton", morton.keyframe);

    std::map<std::string, double> sums;
    Cells before = inOrder(cellsOf(trajectory.frames[warmUp - 1], quantum), order);
    constexpr std::size_t every = 4;  // rivals encode every 4th frame: they are slow, and their frames are similar
    std::size_t frames = 0;
    for (std::size_t k = warmUp; k < trajectory.frames.size(); ++k) {
        const Metres metres = inOrder(trajectory.frames[k], order);
        Cells cells = inOrder(cellsOf(trajectory.frames[k], quantum), order);
        if ((k - warmUp) % every == 0) {
            ++frames;
            for (const Rival& rival : rivals())
                sums[rival.name] +=
                    static_cast<double>(rival.bytes({.metres = metres, .cells = cells, .before = before}));
        }
        before = std::move(cells);
    }
    for (const Rival& rival : rivals())
        add(rival.name, sums[rival.name] / static_cast<double>(frames) / trajectory.spheres);
    return sizes;
}

}  // namespace spherule::bench

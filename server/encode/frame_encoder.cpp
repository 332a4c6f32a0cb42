#include "encode/frame_encoder.h"

#include <algorithm>
#include <utility>

#include "sim/array.h"

namespace spherule::encode {

namespace {

std::string textOf(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

FrameSource sourceOf(sim::Simulation& simulation) {
    FrameSource source{.slotOf = simulation.buffer(sim::Array::SlotOf)};
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        source.columns[column] = simulation.buffer(sim::arrayNamed(codec::columns[column].name).value());
    return source;
}

Result<std::unique_ptr<FrameEncoder>> FrameEncoder::create(EncoderContext& context, v1::Tier tier,
                                                           double smallestRadius) {
    std::unique_ptr<FrameEncoder> frames(new FrameEncoder);
    for (std::size_t column = 0; column < codec::columnCount; ++column) {
        frames->quanta_[column] = codec::columns[column].quantumFor(tier, smallestRadius);
        auto encoder = ColumnEncoder::create(context, {.quantum = frames->quanta_[column]});
        if (!encoder) return tl::unexpected(encoder.error());
        frames->encoders_[column] = std::move(*encoder);
    }
    return frames;
}

void FrameEncoder::encodeKeyframe(const FrameSource& source, bool hash) {
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        encoders_[column]->encodeKeyframe({source.columns[column], source.slotOf}, hash);
}

void FrameEncoder::encodeDelta(const FrameSource& source, bool hash) {
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        encoders_[column]->encodeDelta({source.columns[column], source.slotOf}, hash);
}

void FrameEncoder::encodeResync(bool hash) {
    for (const auto& encoder : encoders_) encoder->encodeResync(hash);
}

bool FrameEncoder::poll(v1::Frame& frame) {
    for (std::size_t column = 0; column < codec::columnCount; ++column) {
        if (arrived_[column]) continue;
        if (const auto bytes = encoders_[column]->poll()) arrived_[column] = textOf(*bytes);
    }
    if (!std::ranges::all_of(arrived_, [](const auto& bytes) { return bytes.has_value(); })) return false;
    write(frame);
    return true;
}

void FrameEncoder::download(v1::Frame& frame) {
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        arrived_[column] = textOf(encoders_[column]->download());
    write(frame);
}

void FrameEncoder::write(v1::Frame& frame) {
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        codec::columns[column].write(frame, quanta_[column], *std::exchange(arrived_[column], std::nullopt));
}

}  // namespace spherule::encode

#include "encode/frame_encoder.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compute/check.h"
#include "sim/array.h"
#include "sim/simulation.h"

namespace spherule::encode {

namespace {

std::string textOf(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

FrameSource sourceOf(sim::Simulation& simulation) {
    FrameSource source{.slotOf = simulation.buffer(sim::Array::SlotOf)};
    for (std::size_t column = 0; column < codec::columnCount; ++column) {
        const std::string_view name = codec::columns[column].name;
        const auto array = sim::arrayNamed(name);
        source.columns[column] = array ? simulation.buffer(*array) : nullptr;
        if (source.columns[column] == nullptr)
            compute::programError(fmt::format("there is no array {} to encode", name));
    }
    source.velocity = simulation.buffer(sim::Array::Velocity);
    return source;
}

Result<std::unique_ptr<FrameEncoder>> FrameEncoder::create(EncoderContext& context, v1::Tier tier,
                                                           double smallestRadius, const glm::dvec3& periods, bool turns,
                                                           bool speeds) {
    std::unique_ptr<FrameEncoder> encoder(new FrameEncoder);
    for (std::size_t column = 0; column < codec::columnCount; ++column) {
        encoder->quanta_[column] = codec::columns[column].quantumFor(tier, smallestRadius);
        const bool places = codec::columns[column].places;
        auto made = ColumnEncoder::create(context, {.quantum = encoder->quanta_[column],
                                                    .periods = places ? periods : glm::dvec3(0),
                                                    .turns = places && turns});
        if (!made) return tl::unexpected(made.error());
        encoder->encoders_[column] = std::move(*made);
    }
    if (speeds) {
        encoder->unitOfSpeed_ = codec::unitOfSpeed(smallestRadius);
        auto made = ColumnEncoder::create(context, {.quantum = encoder->unitOfSpeed_, .speeds = true});
        if (!made) return tl::unexpected(made.error());
        encoder->speeds_ = std::move(*made);
    }
    return encoder;
}

void FrameEncoder::encodeKeyframe(const FrameSource& source, bool hash) {
    forget();
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        encoders_[column]->encodeKeyframe({source.columns[column], source.slotOf}, hash);
    if (speeds_) speeds_->encodeKeyframe({source.velocity, source.slotOf}, hash);
}

void FrameEncoder::encodeDelta(const FrameSource& source, bool hash) {
    forget();
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        encoders_[column]->encodeDelta({source.columns[column], source.slotOf}, hash);
    if (speeds_) speeds_->encodeDelta({source.velocity, source.slotOf}, hash);
}

void FrameEncoder::encodeResync(bool hash) {
    forget();
    for (const auto& encoder : encoders_) encoder->encodeResync(hash);
    if (speeds_) speeds_->encodeResync(hash);
}

void FrameEncoder::forget() {
    arrived_ = {};
    arrivedSpeeds_.reset();
}

bool FrameEncoder::poll(v1::Frame& frame) {
    for (std::size_t column = 0; column < codec::columnCount; ++column) {
        if (arrived_[column]) continue;
        if (const auto bytes = encoders_[column]->poll()) arrived_[column] = textOf(*bytes);
    }
    if (speeds_ && !arrivedSpeeds_)
        if (const auto bytes = speeds_->poll()) arrivedSpeeds_ = textOf(*bytes);
    if (!std::ranges::all_of(arrived_, [](const auto& bytes) { return bytes.has_value(); })) return false;
    if (speeds_ && !arrivedSpeeds_) return false;
    write(frame);
    return true;
}

void FrameEncoder::download(v1::Frame& frame) {
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        arrived_[column] = textOf(encoders_[column]->download());
    if (speeds_) arrivedSpeeds_ = textOf(speeds_->download());
    write(frame);
}

void FrameEncoder::write(v1::Frame& frame) {
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        codec::columns[column].write(frame, quanta_[column], *std::exchange(arrived_[column], std::nullopt));
    if (!speeds_) return;
    frame.set_quantity(v1::SPEED);
    frame.set_unit(unitOfSpeed_);
    frame.set_values(*std::exchange(arrivedSpeeds_, std::nullopt));
}

}  // namespace spherule::encode

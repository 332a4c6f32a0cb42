#include "encode/frame_encoder.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compute/check.h"
#include "core/log.h"
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
    source.quantity = [&simulation](v1::Quantity quantity) -> compute::Buffer* {
        if (quantity == v1::SPEED) return simulation.buffer(sim::Array::Velocity);
        const auto figures = simulation.pipeline().figures();
        if (!figures) spdlog::warn("frames have no {}: {}", v1::Quantity_Name(quantity), figures.error().text());
        return figures ? *figures : nullptr;
    };
    source.spins = simulation.buffer(sim::Array::AngularVelocity);
    return source;
}

Result<void> FrameEncoder::Extra::create(EncoderContext& context, const ColumnEncoder::Grid& grid) {
    auto made = ColumnEncoder::create(context, grid);
    if (!made) return tl::unexpected(made.error());
    encoder = std::move(*made);
    return {};
}

compute::Buffer* FrameEncoder::Extra::take(compute::Buffer* rows) {
    if (rows == nullptr) encoder.reset();
    return encoder ? rows : nullptr;
}

bool FrameEncoder::Extra::poll() {
    if (!encoder || arrived) return true;
    if (const auto bytes = encoder->poll()) arrived = textOf(*bytes);
    return arrived.has_value();
}

void FrameEncoder::Extra::download() {
    if (encoder) arrived = textOf(encoder->download());
}

Result<std::unique_ptr<FrameEncoder>> FrameEncoder::create(EncoderContext& context, v1::Tier tier,
                                                           double smallestRadius, const glm::dvec3& periods, bool turns,
                                                           v1::Quantity quantity, bool spins) {
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
    if (quantity != v1::QUANTITY_UNSPECIFIED) {
        encoder->quantity_ = quantity;
        encoder->unit_ = codec::unitOf(quantity, smallestRadius);
        auto made = encoder->values_.create(context, {.quantum = encoder->unit_, .quantity = quantity});
        if (!made) return tl::unexpected(made.error());
    }
    if (spins) {
        auto made = encoder->spins_.create(context, {.quantum = codec::spinUnit, .spins = true});
        if (!made) return tl::unexpected(made.error());
    }
    return encoder;
}

void FrameEncoder::encodeKeyframe(const FrameSource& source, bool hash) {
    forget();
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        encoders_[column]->encodeKeyframe({source.columns[column], source.slotOf}, hash);
    if (auto* const values = valuesIn(source)) values_.encoder->encodeKeyframe({values, source.slotOf}, hash);
    if (auto* const spins = spins_.take(source.spins)) spins_.encoder->encodeKeyframe({spins, source.slotOf}, hash);
}

void FrameEncoder::encodeDelta(const FrameSource& source, bool hash) {
    forget();
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        encoders_[column]->encodeDelta({source.columns[column], source.slotOf}, hash);
    if (auto* const values = valuesIn(source)) values_.encoder->encodeDelta({values, source.slotOf}, hash);
    if (auto* const spins = spins_.take(source.spins)) spins_.encoder->encodeDelta({spins, source.slotOf}, hash);
}

void FrameEncoder::encodeResync(bool hash) {
    forget();
    for (const auto& encoder : encoders_) encoder->encodeResync(hash);
    for (const Extra* extra : {&values_, &spins_})
        if (extra->encoder) extra->encoder->encodeResync(hash);
}

compute::Buffer* FrameEncoder::valuesIn(const FrameSource& source) {
    return values_.take(values_.encoder && source.quantity ? source.quantity(quantity_) : nullptr);
}

void FrameEncoder::forget() {
    arrived_ = {};
    values_.arrived.reset();
    spins_.arrived.reset();
}

bool FrameEncoder::poll(v1::Frame& frame) {
    for (std::size_t column = 0; column < codec::columnCount; ++column) {
        if (arrived_[column]) continue;
        if (const auto bytes = encoders_[column]->poll()) arrived_[column] = textOf(*bytes);
    }
    const bool values = values_.poll();
    const bool spins = spins_.poll();
    if (!values || !spins) return false;
    if (!std::ranges::all_of(arrived_, [](const auto& bytes) { return bytes.has_value(); })) return false;
    write(frame);
    return true;
}

void FrameEncoder::download(v1::Frame& frame) {
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        arrived_[column] = textOf(encoders_[column]->download());
    values_.download();
    spins_.download();
    write(frame);
}

void FrameEncoder::write(v1::Frame& frame) {
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        codec::columns[column].write(frame, quanta_[column], *std::exchange(arrived_[column], std::nullopt));
    if (values_.encoder) {
        frame.set_quantity(quantity_);
        frame.set_unit(unit_);
        frame.set_values(*std::exchange(values_.arrived, std::nullopt));
    }
    if (spins_.encoder) {
        frame.set_spin_unit(codec::spinUnit);
        frame.set_spins(*std::exchange(spins_.arrived, std::nullopt));
    }
}

}  // namespace spherule::encode

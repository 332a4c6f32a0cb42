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
    return source;
}

Result<std::unique_ptr<FrameEncoder>> FrameEncoder::create(EncoderContext& context, v1::Tier tier,
                                                           double smallestRadius, const glm::dvec3& periods, bool turns,
                                                           v1::Quantity quantity) {
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
        auto made = ColumnEncoder::create(context, {.quantum = encoder->unit_, .quantity = quantity});
        if (!made) return tl::unexpected(made.error());
        encoder->values_ = std::move(*made);
    }
    return encoder;
}

void FrameEncoder::encodeKeyframe(const FrameSource& source, bool hash) {
    forget();
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        encoders_[column]->encodeKeyframe({source.columns[column], source.slotOf}, hash);
    if (compute::Buffer* const values = valuesIn(source)) values_->encodeKeyframe({values, source.slotOf}, hash);
}

void FrameEncoder::encodeDelta(const FrameSource& source, bool hash) {
    forget();
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        encoders_[column]->encodeDelta({source.columns[column], source.slotOf}, hash);
    if (compute::Buffer* const values = valuesIn(source)) values_->encodeDelta({values, source.slotOf}, hash);
}

void FrameEncoder::encodeResync(bool hash) {
    forget();
    for (const auto& encoder : encoders_) encoder->encodeResync(hash);
    if (values_) values_->encodeResync(hash);
}

// Without values, this frame and those after it have no quantity.
compute::Buffer* FrameEncoder::valuesIn(const FrameSource& source) {
    if (!values_) return nullptr;
    compute::Buffer* const values = source.quantity ? source.quantity(quantity_) : nullptr;
    if (values == nullptr) values_.reset();
    return values;
}

void FrameEncoder::forget() {
    arrived_ = {};
    arrivedValues_.reset();
}

bool FrameEncoder::poll(v1::Frame& frame) {
    for (std::size_t column = 0; column < codec::columnCount; ++column) {
        if (arrived_[column]) continue;
        if (const auto bytes = encoders_[column]->poll()) arrived_[column] = textOf(*bytes);
    }
    if (values_ && !arrivedValues_)
        if (const auto bytes = values_->poll()) arrivedValues_ = textOf(*bytes);
    if (!std::ranges::all_of(arrived_, [](const auto& bytes) { return bytes.has_value(); })) return false;
    if (values_ && !arrivedValues_) return false;
    write(frame);
    return true;
}

void FrameEncoder::download(v1::Frame& frame) {
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        arrived_[column] = textOf(encoders_[column]->download());
    if (values_) arrivedValues_ = textOf(values_->download());
    write(frame);
}

void FrameEncoder::write(v1::Frame& frame) {
    for (std::size_t column = 0; column < codec::columnCount; ++column)
        codec::columns[column].write(frame, quanta_[column], *std::exchange(arrived_[column], std::nullopt));
    if (!values_) return;
    frame.set_quantity(quantity_);
    frame.set_unit(unit_);
    frame.set_values(*std::exchange(arrivedValues_, std::nullopt));
}

}  // namespace spherule::encode

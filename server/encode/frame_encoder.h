#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <glm/vec3.hpp>

#include "codec/columns.h"
#include "core/result.h"
#include "encode/column_encoder.h"

namespace spherule::sim {
class Simulation;
}

namespace spherule::encode {

// The buffers with the values of all columns. slotOf: as in ColumnSource.
struct FrameSource {
    codec::PerColumn<compute::Buffer*> columns{};
    compute::Buffer* velocity = nullptr;  // null: unknown
    compute::Buffer* slotOf = nullptr;
};

// Returns the arrays of a simulation. Valid until its next command.
FrameSource sourceOf(sim::Simulation& simulation);

// Encodes the frames of one chain: all columns of codec/columns.h, and a quantity if it is asked for, each with a
// ColumnEncoder. Used by the thread that owns the device.
class FrameEncoder {
  public:
    // `context` must outlive the encoder. `smallestRadius` in m. `periods`, `turns`: of positions, see
    // ColumnEncoder::Grid. `speeds`: frames have the speeds; their sources must have velocities. Refused if there is no
    // room.
    static Result<std::unique_ptr<FrameEncoder>> create(EncoderContext& context, v1::Tier tier, double smallestRadius,
                                                        const glm::dvec3& periods = {}, bool turns = false,
                                                        bool speeds = false);

    // See ColumnEncoder.
    void encodeKeyframe(const FrameSource& source, bool hash);
    void encodeDelta(const FrameSource& source, bool hash);
    void encodeResync(bool hash);

    // Write the columns of the frame into `frame`. poll() returns false while the device copies them to the host. Call
    // it until it returns true, before the next frame is encoded. download() waits for the device.
    bool poll(v1::Frame& frame);
    void download(v1::Frame& frame);

    [[nodiscard]] std::uint32_t number() const { return encoders_.front()->number(); }  // number of the frame

  private:
    FrameEncoder() = default;
    void forget();
    void write(v1::Frame& frame);

    codec::PerColumn<std::unique_ptr<ColumnEncoder>> encoders_;
    codec::PerColumn<double> quanta_{};
    codec::PerColumn<std::optional<std::string>> arrived_;
    std::unique_ptr<ColumnEncoder> speeds_;  // null: frames have no speeds
    double unitOfSpeed_ = 0;
    std::optional<std::string> arrivedSpeeds_;
};

}  // namespace spherule::encode

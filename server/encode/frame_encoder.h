#pragma once

#include <cstdint>
#include <functional>
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
    compute::Buffer* slotOf = nullptr;
    // Returns the rows from which a quantity is coded (ColumnEncoder::Grid), computed for the present state if need be;
    // null if they cannot be computed. Empty: the source has no quantities.
    std::function<compute::Buffer*(v1::Quantity)> quantity{};
    compute::Buffer* spins = nullptr;  // angular velocities (rad/s); null: the source has none
};

// Returns the arrays of a simulation. Valid until its next command.
FrameSource sourceOf(sim::Simulation& simulation);

// Encodes the frames of one chain: all columns of codec/columns.h, and a quantity and the angular velocities if they
// are asked for, each with a ColumnEncoder. Used by the thread that owns the device.
class FrameEncoder {
  public:
    // `context` must outlive the encoder. `smallestRadius` in m. `periods`, `turns`: of positions, see
    // ColumnEncoder::Grid. `quantity`: that frames have too, unless a source has none; `spins`: likewise. Refused if
    // there is no room.
    static Result<std::unique_ptr<FrameEncoder>> create(EncoderContext& context, v1::Tier tier, double smallestRadius,
                                                        const glm::dvec3& periods = {}, bool turns = false,
                                                        v1::Quantity quantity = v1::QUANTITY_UNSPECIFIED,
                                                        bool spins = false);

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
    // A column that not every chain has.
    struct Extra {
        std::unique_ptr<ColumnEncoder> encoder;  // null: frames do not have the column
        std::optional<std::string> arrived;

        Result<void> create(EncoderContext& context, const ColumnEncoder::Grid& grid);
        // Returns `rows` if the column is encoded. Without rows, this frame and those after it do not have it.
        compute::Buffer* take(compute::Buffer* rows);
        bool poll();  // true: the column has arrived, or there is none
        void download();
    };

    FrameEncoder() = default;
    compute::Buffer* valuesIn(const FrameSource& source);
    void forget();
    void write(v1::Frame& frame);

    codec::PerColumn<std::unique_ptr<ColumnEncoder>> encoders_;
    codec::PerColumn<double> quanta_{};
    codec::PerColumn<std::optional<std::string>> arrived_;
    Extra values_;  // of the quantity
    v1::Quantity quantity_ = v1::QUANTITY_UNSPECIFIED;
    double unit_ = 0;
    Extra spins_;
};

}  // namespace spherule::encode

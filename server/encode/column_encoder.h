#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "compute/device.h"
#include "core/memory.h"
#include "core/result.h"
#include "encode/codec_layout.h"
#include "spherule/v1/frame.pb.h"

// The encoder of docs/codec.md on a device. Used by the thread that owns the device.
namespace spherule::encode {

// The memory of the encoders of a scene (bytes).
struct EncoderBytes {
    std::uint64_t contextArrays = 0;  // on the device, shared by all encoders of a scene
    std::uint64_t order = 0;          // on the host: ids, and the message that sends them to viewers
    std::uint64_t encoderArrays = 0;  // on the device, for each column of each chain
    std::uint64_t frames = 0;         // on the host, likewise: frames in transit to viewers, each of a usual size
};
EncoderBytes encoderBytes(std::uint32_t spheres);

// The data that all encoders of a scene share: kernels, the order, and scratch arrays for the frame being encoded.
class EncoderContext {
  public:
    // `spheres`: at least 1; the order is by id at first. `slots`: values are stored by slot, and slotOf maps id to
    // slot. Refused if there is no room.
    // `kernels`: of an earlier context with the same `slots`, or null.
    struct Kernels;
    static Result<std::unique_ptr<EncoderContext>> create(compute::Device& device, std::uint32_t spheres, bool slots,
                                                          std::shared_ptr<Kernels> kernels = nullptr);
    [[nodiscard]] std::shared_ptr<Kernels> kernels() const { return kernels_; }

    // Sets the id of each sphere in codec order: its index in slotOf, or its slot.
    void setOrder(std::span<const std::uint32_t> order);

    [[nodiscard]] std::uint32_t spheres() const { return spheres_; }

  private:
    friend class ColumnEncoder;
    enum Kernel : std::uint8_t { Choose, Sum, Reduce, Top, Spread, Layout, Place, Hash, KernelCount };

    EncoderContext(compute::Device& device, std::uint32_t spheres);
    struct Binding {
        std::string_view name;  // of the kernel's buffer
        compute::Buffer* buffer;
    };
    void run(Kernel kernel, std::initializer_list<Binding> bindings, std::uint32_t count, std::uint32_t phase = 0);

    compute::Device& device_;
    memory::Claim claim_;
    std::uint32_t spheres_, blocks_, groups_, chunks_;
    std::shared_ptr<Kernels> kernels_;
    std::unique_ptr<compute::Buffer> order_, blockWords_, scratch_, groupWords_, sums_, parameters_;
};

// A buffer with the values of a column: vec4, of which the codec takes what Grid::quantity says. slotOf: slot
// by id; null, or ignored, if the context was created without slots.
struct ColumnSource {
    compute::Buffer* values = nullptr;
    compute::Buffer* slotOf = nullptr;
};

// Encodes one column of the frames of a chain, with its own quantum. A frame stays in the encoder until the next one is
// encoded.
class ColumnEncoder {
  public:
    struct Grid {
        glm::vec3 origin{};  // where values count from; best in the middle of their range
        double quantum = 0;
        // With periodic axes: values are positions (m, from the middle of the bounds), which repeat after these
        // lengths; 0 along the other axes. They are moved to their images inside the bounds.
        glm::dvec3 periods{};
        bool turns = false;  // the frames count modulo these lengths
        // The content of frames: positions, or a quantity of each row of the values. For SPEED the rows are velocities
        // (m/s), for other quantities rows of shaders/figures.comp. The quantum is the unit of docs/codec.md.
        v1::Quantity quantity = v1::QUANTITY_UNSPECIFIED;
        bool spins = false;  // in place of these: angular velocities (rad/s), with the unit of docs/codec.md
    };

    // `context` must outlive the encoder. Refused if there is no room.
    static Result<std::unique_ptr<ColumnEncoder>> create(EncoderContext& context, const Grid& grid);

    // Encode a frame. With `hash`, the frame carries the hash of its state. A keyframe begins a chain, and deltas
    // follow it. A resync is a keyframe of the newest frame's state, with the same number.
    void encodeKeyframe(const ColumnSource& source, bool hash = false);
    void encodeDelta(const ColumnSource& source, bool hash = false);
    void encodeResync(bool hash = false);

    // Returns the frame once it has arrived on the host. Returns nullopt while it is being copied, or while the device
    // has no free place for a copy. Call it until it returns the frame, before the next one is encoded. Copies only the
    // bytes of the frame.
    std::optional<std::vector<std::byte>> poll();
    std::vector<std::byte> download();  // the frame; waits for the device

    [[nodiscard]] std::uint32_t number() const { return number_; }  // number of the frame

  private:
    ColumnEncoder(EncoderContext& context, const Grid& grid) : context_(context), grid_(grid) {}
    enum class Kind : std::uint8_t { Keyframe, Delta, Resync };
    void encode(Kind kind, const ColumnSource& source, bool hash);
    [[nodiscard]] std::size_t bytesOf(std::span<const std::byte> head) const;
    [[nodiscard]] std::size_t headBytes() const;
    [[nodiscard]] glm::uvec3 turns() const;
    [[nodiscard]] std::uint32_t headWords() const;

    EncoderContext& context_;
    memory::Claim claim_;
    Grid grid_;
    std::unique_ptr<compute::Buffer> newest_, before_, frame_;
    std::uint32_t number_ = 0;
    bool keyframe_ = false;                    // the frame is a keyframe
    bool still_ = false;                       // a keyframe was made since the last delta frame
    std::unique_ptr<compute::ReadBack> copy_;  // under way
    std::size_t copied_ = 0;                   // bytes of it
};

}  // namespace spherule::encode

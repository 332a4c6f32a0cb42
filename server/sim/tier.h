#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "compute/device.h"
#include "core/memory.h"
#include "core/result.h"
#include "sim/codec_layout.h"

// The encoder of docs/codec.md on a device. Used by the thread that owns the device.
namespace spherule::sim {

// The memory of the frame encoder (bytes).
struct TierSizes {
    std::uint64_t toolArrays = 0;  // on the device, shared by all tiers of a scene
    std::uint64_t order = 0;       // on the host: ids, and the message that sends them to viewers
    std::uint64_t tierArrays = 0;  // on the device, for each tier
    std::uint64_t frames = 0;      // on the host, for each tier: frames in transit to viewers, each of a usual size
};
TierSizes tierSizes(std::uint32_t spheres);

// The data that all tiers of a scene share: kernels, the order, and scratch arrays for the frame being encoded.
class TierTools {
  public:
    // `spheres`: at least 1; the order is by id at first. `slots`: positions are stored by slot, and slotOf maps id to
    // slot. Refused if there is no room.
    static Result<std::unique_ptr<TierTools>> create(compute::Device& device, std::uint32_t spheres, bool slots);

    // Sets the ids in codec order, a permutation of 0 .. spheres - 1. Every tier must begin() again afterwards.
    void setOrder(std::span<const std::uint32_t> order);

    [[nodiscard]] std::uint32_t spheres() const { return spheres_; }

  private:
    friend class Tier;
    enum Kernel : std::uint8_t { Choose, Sum, Reduce, Top, Spread, Layout, Place, Hash, KernelCount };

    TierTools(compute::Device& device, std::uint32_t spheres);
    struct Binding {
        std::string_view name;  // of the kernel's buffer
        compute::Buffer* buffer;
    };
    void run(Kernel kernel, std::initializer_list<Binding> bindings, std::uint32_t count, std::uint32_t phase = 0);

    compute::Device& device_;
    memory::Claim claim_;
    std::uint32_t spheres_, blocks_, groups_, chunks_;
    std::array<std::unique_ptr<compute::Kernel>, KernelCount> kernels_;
    std::unique_ptr<compute::Buffer> order_, blockWords_, scratch_, groupWords_, sums_, parameters_;
};

// The buffers with the positions: vec4, xyz in m. slotOf: slot by id; ignored if the tools were created without slots.
struct TierSource {
    compute::Buffer* position = nullptr;
    compute::Buffer* slotOf = nullptr;
};

// One chain of frames with its own quantum. A frame stays in the tier until the next one is encoded.
class Tier {
  public:
    struct Grid {
        glm::vec3 origin{};  // m, where positions count from; best in the middle of the domain
        double quantum = 0;  // m
    };

    // `tools` must outlive the tier. Refused if there is no room.
    static Result<std::unique_ptr<Tier>> create(TierTools& tools, const Grid& grid);

    // With `hash`, the frame carries the hash of its state.
    void begin(const TierSource& source, bool hash = false);  // a keyframe of the positions: a chain begins
    void next(const TierSource& source, bool hash = false);   // the delta frame of the positions; after begin()
    void join(bool hash = false);  // a keyframe of the same state, with the number of the frame before

    // Returns the frame once it has arrived on the host. Returns nullopt while it is being copied, or while the device
    // has no free place for a copy. Call it until it returns the frame, before the next one is encoded. Copies only the
    // bytes of the frame.
    std::optional<std::vector<std::byte>> poll();
    std::vector<std::byte> download();  // the frame; waits for the device

    [[nodiscard]] std::uint32_t number() const { return number_; }  // number of the frame

  private:
    Tier(TierTools& tools, const Grid& grid) : tools_(tools), grid_(grid) {}
    enum class Kind : std::uint8_t { Begin, Next, Join };
    void encode(Kind kind, const TierSource& source, bool hash);
    [[nodiscard]] std::size_t bytesOf(std::span<const std::byte> head) const;
    [[nodiscard]] std::size_t headBytes() const;

    TierTools& tools_;
    memory::Claim claim_;
    Grid grid_;
    std::unique_ptr<compute::Buffer> newest_, before_, frame_;
    std::uint32_t number_ = 0;
    bool keyframe_ = false;                    // the frame is a keyframe
    bool still_ = false;                       // a keyframe was made since the last delta frame
    std::unique_ptr<compute::ReadBack> copy_;  // under way
    std::size_t copied_ = 0;                   // bytes of it
};

}  // namespace spherule::sim

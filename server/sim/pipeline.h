#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "compute/device.h"
#include "sim/layout.h"
#include "sim/plan.h"
#include "sim/state.h"

namespace spherule::sim {

// What the device holds of the spheres, as it lies there.
struct SlotState {
    std::vector<glm::vec4> position;
    std::vector<glm::vec4> velocity;
    std::vector<glm::vec4> angularVelocity;  // with friction, else empty
    std::vector<std::uint32_t> idAndMaterial;
};

State inIdOrder(const SlotState& slots);

// The arrays to bind for a launch, in the order of the buffers that its kernel declares. NoDevice for a buffer without
// an array, of another type than its array, and for an alias that the kernel does not declare.
Result<std::vector<Array>> arraysFor(const LaunchSpec& launch, const compute::Kernel& kernel);

// A plan on a device: its arrays and its kernels. Used by the thread that owns the device.
class Pipeline {
  public:
    // Without arrays and kernels: makeNext() makes them.
    Pipeline(compute::Device& device, Plan plan);

    // Makes one more array or kernel. False once all are there.
    Result<bool> makeNext();
    [[nodiscard]] double shareMade() const;  // of arrays and kernels, 0 to 1

    void setParameters(const layout::Parameters& parameters);
    // In id order, as are the materials of the spheres; the lists are rebuilt in the next substep.
    void upload(const State& state, std::span<const std::uint8_t> materials);
    [[nodiscard]] SlotState download();  // waits for the device
    void download(SlotState& slots);     // the same, in the memory that there is

    void substep(bool observed = false);
    // Of each cell group what the observed steps since the last call have seen, as statistics_impacts.comp adds it up;
    // empty when there were none. Waits for the device.
    std::vector<glm::vec4> takeImpacts();
    void runStatistics();  // of the state as it is: builds the lists first where they are not those of this state

    // Whole array as elements of T, or the first `most` of them; waits for the device. Empty where the plan has no such
    // array.
    template <class T>
    std::vector<T> read(Array array, std::size_t most = SIZE_MAX) {
        std::vector<T> values;
        readInto(values, array, most);
        return values;
    }
    template <class T>
    void readInto(std::vector<T>& values, Array array, std::size_t most = SIZE_MAX) {
        values.resize(std::min(static_cast<std::size_t>(plan_.bytesOf(array)) / sizeof(T), most));
        if (!values.empty()) device_.download(buffer(array), 0, std::as_writable_bytes(std::span(values)));
    }
    template <class T>
    void write(Array array, std::span<const T> values, std::size_t first = 0) {
        device_.upload(buffer(array), first * sizeof(T), std::as_bytes(values));
    }

    // Wakes a sphere and gives it an impulse, in N s. Waits for the device.
    void kick(std::uint32_t id, glm::vec3 impulse);
    [[nodiscard]] glm::vec4 velocityOf(std::uint32_t id);  // waits for the device

    // Ends all sleep. Waits for the device.
    void wakeAll();

    // Room for more pairs; the lists are rebuilt.
    Result<void> growPairs(std::uint32_t capacity);

    [[nodiscard]] const Plan& plan() const { return plan_; }
    [[nodiscard]] compute::Buffer& buffer(Array array) { return *buffers_[static_cast<std::size_t>(array)]; }

  private:
    Result<void> makeSmallArrays();
    Result<void> makeArray(const ArraySpec& spec);
    Result<void> makeKernel(std::string_view file);
    void fillLaunches();
    void copy(compute::Buffer& from, compute::Buffer& to);
    std::uint32_t slotOf(std::uint32_t id);
    void adopt(Array array, std::unique_ptr<compute::Buffer> made);
    // A launch of the plan, with its kernel and the arrays to bind, by slot.
    struct BoundLaunch {
        const LaunchSpec* spec = nullptr;
        const compute::Kernel* kernel = nullptr;
        std::vector<Array> arrays;
    };
    Result<void> bindAll();
    enum class Which : std::uint8_t { Substep, ObservedSubstep, Rebuild };
    void run(const std::vector<BoundLaunch>& launches, Which which);

    compute::Device& device_;
    Plan plan_;
    std::vector<std::string_view> kernelFiles_;  // that the plan launches
    std::size_t arraysMade_ = 0;                 // of plan_.arrays
    bool listsPending_ = false;
    bool impactsPending_ = false;
    std::array<std::unique_ptr<compute::Buffer>, arrayCount> owned_;
    std::array<compute::Buffer*, arrayCount> buffers_{};  // where the plan has none: a small one that nothing touches
    std::unique_ptr<compute::Buffer> absent_;
    std::unique_ptr<compute::Buffer> parameters_;
    std::vector<std::unique_ptr<compute::Kernel>> kernels_;
    std::vector<BoundLaunch> substep_, statistics_;
};

}  // namespace spherule::sim

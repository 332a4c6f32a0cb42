#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

// Devices that run kernels. They are independent of the simulation. All calls must come from the thread that created
// the device.
namespace spherule::compute {

struct DeviceInfo {
    std::string kind;      // "gpu", "cpu" or "software"
    std::string renderer;  // GL_RENDERER, or the processor and the number of threads
    std::string vendor;
    std::string version;
    std::string reason;  // why this device was chosen, one sentence
    std::size_t maxBufferBytes = 0;
    bool robust = false;  // reports a lost context
};

// Device memory, filled with zeros at creation.
class Buffer {
  public:
    virtual ~Buffer() = default;
    [[nodiscard]] virtual std::size_t bytes() const = 0;
};

// Storage buffers that one kernel may declare. OpenGL guarantees 8; a device with fewer than this is not opened.
constexpr std::size_t maxKernelBuffers = 16;

// A buffer as a kernel declares it: `BUFFER(access, type, name)`.
struct BufferDeclaration {
    std::string_view type;  // of its elements: "vec4", "uint", "ContactParams"
    std::string_view name;
};

class Kernel {
  public:
    virtual ~Kernel() = default;
    [[nodiscard]] virtual const std::string& name() const = 0;
    // Returns the buffers in the order of the source; the first is bound at slot 0. Valid as long as the kernel.
    [[nodiscard]] virtual std::span<const BufferDeclaration> buffers() const = 0;
};

struct Define {
    std::string name;
    std::string value;
};

// Kernel source by file name ("integrate.comp", "shared/kernel.h").
class SourceSet {
  public:
    virtual ~SourceSet() = default;
    [[nodiscard]] virtual std::optional<std::string_view> find(std::string_view name) const = 0;
};

// One launch of `count` invocations, or of `count` work groups if the kernel is a BUNDLE_KERNEL or a PAIR_KERNEL
// (shaders/shared/kernel.h); 0 launches nothing. With `arguments`, the uvec4 at `argumentsOffset` (bytes) holds the
// groups x, y, z and `count` instead.
struct Launch {
    const Kernel* kernel = nullptr;
    std::span<Buffer* const> buffers;  // in the order of Kernel::buffers()
    Buffer* parameters = nullptr;      // the uniform block, which only upload() writes; may be null
    std::uint32_t phase = 0;           // the kernel's `phase`
    std::uint32_t count = 0;
    Buffer* arguments = nullptr;
    std::size_t argumentsOffset = 0;
};

// A copy of device memory to the host that is under way. The device continues meanwhile.
class ReadBack {
  public:
    virtual ~ReadBack() = default;
    // Returns the bytes once they have arrived; nullopt before. Does not wait.
    [[nodiscard]] virtual std::optional<std::span<const std::byte>> poll() = 0;
};

// Copies single words to the host while the device continues.
class WordQueue {
  public:
    static constexpr std::size_t most = 4;  // words under way

    virtual ~WordQueue() = default;
    // Starts to copy the 32-bit word at `offset` (bytes), as the launches so far leave it.
    virtual void start(const Buffer& buffer, std::size_t offset) = 0;
    [[nodiscard]] virtual std::size_t underWay() const = 0;
    // Returns the word whose copy started first, and waits for it. All its bits are set if the device is lost.
    virtual std::uint32_t take() = 0;
};

class Device {
  public:
    virtual ~Device() = default;
    [[nodiscard]] virtual const DeviceInfo& info() const = 0;

    // Refused, with the size and the limit, if the device has no room for the buffer or a kernel cannot access all of
    // it. `label`: name for errors and debuggers. `words`: types of the buffer's 32-bit words, repeated to its end. 'r'
    // is a real number (float32 on the host), 'u' an unsigned integer. Only a device with double precision uses
    // `words`.
    virtual Result<std::unique_ptr<Buffer>> createBuffer(std::string_view label, std::size_t bytes,
                                                         std::string_view words = "u") = 0;

    // Returns the host memory (bytes) that such a buffer uses: 0 on a device with its own memory.
    [[nodiscard]] virtual std::uint64_t hostBytes(std::uint64_t bytes, std::string_view words = "u") const = 0;

    // Compiles `file` with the defines. An error contains the compiler's messages with file and line. A kernel has a
    // local size of 64 (or of 1, to measure the cost of small groups). A PAIR_KERNEL or a BUNDLE_KERNEL has the size
    // that suits the device. A kernel has at most maxKernelBuffers storage buffers and at most one uniform block
    // (binding 0). It may have the uniforms `phase` and `invocations`. `invocations` is the invocation count, or
    // 0xffffffff in an indirect launch, in which the kernel reads the count itself. The index of an invocation is
    // gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * local size. The CPU device contains the
    // kernels of shaders/ and accepts no others.
    virtual Result<std::unique_ptr<Kernel>> createKernel(const SourceSet& sources, std::string_view file,
                                                         std::span<const Define> defines) = 0;

    virtual void upload(Buffer& buffer, std::size_t offset, std::span<const std::byte> bytes) = 0;
    // Waits for all earlier launches.
    virtual void download(const Buffer& buffer, std::size_t offset, std::span<std::byte> bytes) = 0;
    virtual void fill(Buffer& buffer, std::uint32_t value) = 0;
    // Copies from one buffer to another of the same words (see createBuffer()), without the host. Does not wait. Both
    // offsets (bytes) must be at the same place in the pattern of words.
    virtual void copy(const Buffer& from, std::size_t fromOffset, std::size_t bytes, Buffer& to,
                      std::size_t toOffset) = 0;

    // Every launch sees the writes of all earlier launches. The program ends if the launch lacks a buffer that the
    // kernel declares, even an unused one, because the launch could compute wrong results.
    virtual void launch(const Launch& launch) = 0;

    // Starts a copy to the host. Returns nullptr if two copies are already under way.
    virtual std::unique_ptr<ReadBack> startReadBack(const Buffer& buffer, std::size_t bytes) = 0;

    virtual std::unique_ptr<WordQueue> createWordQueue() = 0;

    // Add the device time between beginTimer() and endTimer() to `slot`. takeTimes() returns the time (s) per slot and
    // resets all slots. Only takeTimes() waits for the device. Timers do not nest. On a GPU a timer takes about as long
    // as a launch, so they can be turned off, while none runs.
    virtual void useTimers(bool use) = 0;
    virtual void beginTimer(unsigned slot) = 0;
    virtual void endTimer() = 0;
    virtual std::vector<double> takeTimes() = 0;

    virtual void finish() = 0;                        // waits until the device is idle
    [[nodiscard]] virtual Result<void> status() = 0;  // DeviceLost if the context is lost
};

// Opens a device. Input if `choice` is not one of the following, NoDevice if there is no such device.
// - "auto": a hardware GPU, else the CPU. DeviceInfo::reason gives the reason.
// - "gpu": a hardware GPU. "gpu:N": the hardware device with number N in the list of `spherule probe`. "gpu:cuda:N":
//   NVIDIA's device with the CUDA number N.
// - "cpu": the CPU. "cpu:N": the CPU with N threads. "cpu:NxL": with L lanes (1, 4, 8 or 16), to compare them.
// - "cpu-double", "cpu-double:N": the CPU in double precision, to separate rounding errors from errors of the method.
//   Values from the host, such as the substep, stay float.
// - "software": Mesa's software renderer.
Result<std::unique_ptr<Device>> openDevice(const std::string& choice);

}  // namespace spherule::compute

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

// A place where kernels run. Knows nothing of spheres. All calls come from the thread that created the device.
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
    std::string_view type;  // of its elements: "vec4", "uint", "Law"
    std::string_view name;
};

class Kernel {
  public:
    virtual ~Kernel() = default;
    [[nodiscard]] virtual const std::string& name() const = 0;
    // In the order of the text; the first is bound at slot 0. Valid as long as the kernel.
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

// One launch: `count` invocations (none: nothing happens), or as many as the uvec4 at `argumentsOffset` (bytes) of
// `arguments` says (groups x, y, z, then the invocation count).
struct Launch {
    const Kernel* kernel = nullptr;
    std::span<Buffer* const> buffers;  // in the order of Kernel::buffers()
    Buffer* parameters = nullptr;      // the uniform block; may be null
    std::uint32_t phase = 0;           // the kernel's `phase`
    std::uint32_t count = 0;
    Buffer* arguments = nullptr;
    std::size_t argumentsOffset = 0;
};

// Copy of device memory on its way to the host; the device goes on meanwhile.
class ReadBack {
  public:
    virtual ~ReadBack() = default;
    // The bytes once they have arrived, without waiting; empty before.
    [[nodiscard]] virtual std::optional<std::span<const std::byte>> poll() = 0;
};

class Device {
  public:
    virtual ~Device() = default;
    [[nodiscard]] virtual const DeviceInfo& info() const = 0;

    // Refused, with both figures, when the device has no room for it or a kernel could not see all of it. The label is
    // for errors and debuggers. `words` says what its 32-bit words are, in turn and again and again: 'r' a real number
    // (float32 to the host), 'u' an unsigned integer; only a device that computes in double precision asks.
    virtual Result<std::unique_ptr<Buffer>> createBuffer(std::string_view label, std::size_t bytes,
                                                         std::string_view words = "u") = 0;

    // What such a buffer takes of the machine's memory: nothing on a device that has its own.
    [[nodiscard]] virtual std::uint64_t hostBytes(std::uint64_t bytes, std::string_view words = "u") const = 0;

    // Compiles `file` with the defines; an error carries the compiler's text with file and line. A kernel has a local
    // size of 64 (or of 1, to measure what that costs), at most maxKernelBuffers storage buffers, at most one uniform
    // block (binding 0), and may have the uniforms `phase` and `invocations` (its count; 0xffffffff when launched
    // indirectly: then it reads the count itself). Its index is
    // gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * local size. The CPU device has the
    // kernels of shaders/ compiled in and takes no others.
    virtual Result<std::unique_ptr<Kernel>> createKernel(const SourceSet& sources, std::string_view file,
                                                         std::span<const Define> defines) = 0;

    virtual void upload(Buffer& buffer, std::size_t offset, std::span<const std::byte> bytes) = 0;
    // Waits for all launches before.
    virtual void download(const Buffer& buffer, std::size_t offset, std::span<std::byte> bytes) = 0;
    virtual void fill(Buffer& buffer, std::uint32_t value) = 0;

    // Every launch sees what the launches before it wrote. A buffer that the kernel declares and the launch lacks, used
    // or not, ends the program: it would compute wrong results.
    virtual void launch(const Launch& launch) = 0;

    // At most two copies are under way at once: nothing when both places are taken.
    virtual std::unique_ptr<ReadBack> startReadBack(const Buffer& buffer, std::size_t bytes) = 0;

    // Device time between begin and end is added to `slot`; takeTimes returns seconds per slot and starts anew. The
    // first waits for nothing, the last for all launches before. Timers do not nest.
    virtual void beginTimer(unsigned slot) = 0;
    virtual void endTimer() = 0;
    virtual std::vector<double> takeTimes() = 0;

    virtual void finish() = 0;                        // waits until the device is idle
    [[nodiscard]] virtual Result<void> status() = 0;  // DeviceLost when the context is gone
};

// "auto" (a hardware GPU, else "cpu", and the info's reason says why), "gpu", "gpu:N" (N counts the hardware devices as
// `spherule probe` lists them), "cpu", "cpu:N" (with N threads), "cpu-double" (the same in double precision, to tell
// rounding from method; what the host hands over, such as the substep, stays float) or "software" (Mesa's renderer).
// Input for anything else, NoDevice when there is none.
Result<std::unique_ptr<Device>> openDevice(const std::string& choice);

}  // namespace spherule::compute

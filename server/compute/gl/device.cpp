#include "compute/gl/device.h"

#include <algorithm>
#include <cstring>

#include <spdlog/fmt/fmt.h>

#include "compute/check.h"
#include "compute/gl/buffer.h"
#include "compute/gl/kernel.h"
#include "compute/gl/limits.h"
#include "compute/gl/word_queue.h"
#include "core/heartbeat.h"

namespace spherule::compute::gl {
namespace {

constexpr std::uint32_t maxGroupsX = 32768;          // GL allows at least 65535 in each direction
constexpr std::uint32_t countInBuffer = 0xffffffff;  // `invocations` of an indirect launch
constexpr std::size_t uploadChunk = std::size_t{4} << 20U;
constexpr std::size_t downloadChunk = std::size_t{16} << 20U;

const GlBuffer& glBuffer(const Buffer& buffer) {
    return static_cast<const GlBuffer&>(buffer);
}

void bindBuffers(State& state, const GlKernel& kernel, const Launch& launch) {
    for (const auto& slot : kernel.slots()) {
        const Buffer* const buffer = slot.binding < launch.buffers.size() ? launch.buffers[slot.binding] : nullptr;
        if (buffer == nullptr) {
            programError(fmt::format("{} is launched without a buffer for {} at slot {}", kernel.name(), slot.block,
                                     slot.binding));
        }
        state.bindStorage(slot.binding, glBuffer(*buffer).id());
    }
    if (kernel.wantsParameters()) {
        if (launch.parameters == nullptr) programError(kernel.name() + " is launched without its parameters");
        state.bindUniforms(glBuffer(*launch.parameters).id());
    }
}

// Divides the groups into rows of equal length, so that the last row wastes little.
void dispatch(std::uint32_t groups) {
    const std::uint32_t rows = (groups + maxGroupsX - 1) / maxGroupsX;
    glDispatchCompute((groups + rows - 1) / rows, rows, 1);
}

}  // namespace

GlDevice::GlDevice(const Opened& opened)
    : context_(opened.context),
      fences_(context_),
      uploads_(context_, Staging::Direction::ToDevice),
      downloads_(context_, Staging::Direction::FromDevice),
      readBacks_(std::make_shared<ReadBackPlaces>(context_)),
      timers_(context_) {
    context_->use();
    info_.kind = opened.kind;
    info_.renderer = context_->renderer();
    info_.vendor = context_->vendor();
    info_.version = context_->version();
    info_.reason = opened.reason;
    info_.maxBufferBytes = queryLimits().maxBufferBytes;
    info_.robust = context_->robust();
}

Result<std::unique_ptr<Buffer>> GlDevice::createBuffer(std::string_view label, std::size_t bytes,
                                                       std::string_view /*words*/) {
    if (bytes > info_.maxBufferBytes) {
        return fail(ErrorKind::Refused, std::string(label),
                    fmt::format("needs {} bytes ({} MiB), but a kernel of {} sees at most {} bytes of one buffer; use "
                                "fewer spheres or another device",
                                bytes, bytes >> 20U, info_.renderer, info_.maxBufferBytes));
    }
    heartbeat::beat("making room on the device");
    return GlBuffer::create(context_, label, bytes);
}

std::uint64_t GlDevice::hostBytes(std::uint64_t bytes, std::string_view /*words*/) const {
    return info_.kind == "gpu" ? 0 : bytes;
}

Result<std::unique_ptr<Kernel>> GlDevice::createKernel(const SourceSet& sources, std::string_view file,
                                                       std::span<const Define> defines) {
    heartbeat::beat("compiling a kernel");
    return GlKernel::create(context_, sources, file, defines);
}

// Copies through a staging buffer: NVIDIA's driver 580 loses a glNamedBufferSubData of 128 KiB or more that follows a
// clear of the same buffer. The staging buffer keeps its content until the device has read it: a full one waits.
void GlDevice::upload(Buffer& buffer, std::size_t offset, std::span<const std::byte> bytes) {
    checkRange("upload", buffer, offset, bytes.size());
    heartbeat::beat("copying to the device");
    context_->use();
    context_->state().beforeCopy();
    while (!bytes.empty()) {
        if (!uploads_.reserve(uploadChunk)) {
            copiesFail_ = true;
            return;
        }
        if (uploadsUsed_ == uploadChunk) finish();
        const std::size_t part = std::min(bytes.size(), uploadChunk - uploadsUsed_);
        std::memcpy(uploads_.data() + uploadsUsed_, bytes.data(), part);
        glCopyNamedBufferSubData(uploads_.id(), glBuffer(buffer).id(), static_cast<GLintptr>(uploadsUsed_),
                                 static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(part));
        context_->state().afterCopy();
        uploadsUsed_ += (part + 15) / 16 * 16;  // the next copy begins at a whole vector
        offset += part;
        bytes = bytes.subspan(part);
    }
}

// Copies through a staging buffer, too: after a direct read, some drivers keep the buffer in host memory.
void GlDevice::download(const Buffer& buffer, std::size_t offset, std::span<std::byte> bytes) {
    checkRange("download", buffer, offset, bytes.size());
    context_->use();
    context_->state().beforeCopy();
    while (!bytes.empty()) {
        const std::size_t part = std::min(bytes.size(), downloadChunk);
        if (!downloads_.reserve(part)) {
            copiesFail_ = true;
            std::memset(bytes.data(), 0, bytes.size());
            return;
        }
        glCopyNamedBufferSubData(glBuffer(buffer).id(), downloads_.id(), static_cast<GLintptr>(offset), 0,
                                 static_cast<GLsizeiptr>(part));
        context_->state().afterCopy();
        finish();
        std::memcpy(bytes.data(), downloads_.data(), part);
        offset += part;
        bytes = bytes.subspan(part);
    }
}

void GlDevice::fill(Buffer& buffer, std::uint32_t value) {
    context_->use();
    context_->state().beforeCopy();
    glClearNamedBufferData(glBuffer(buffer).id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
    context_->state().afterCopy();
}

void GlDevice::copy(const Buffer& from, std::size_t fromOffset, std::size_t bytes, Buffer& to, std::size_t toOffset) {
    checkRange("copy", from, fromOffset, bytes);
    checkRange("copy", to, toOffset, bytes);
    context_->use();
    context_->state().beforeCopy();
    glCopyNamedBufferSubData(glBuffer(from).id(), glBuffer(to).id(), static_cast<GLintptr>(fromOffset),
                             static_cast<GLintptr>(toOffset), static_cast<GLsizeiptr>(bytes));
    context_->state().afterCopy();
}

void GlDevice::launch(const Launch& launch) {
    if (launch.kernel == nullptr) programError("a launch without a kernel");
    const auto& kernel = static_cast<const GlKernel&>(*launch.kernel);
    heartbeat::beat("launching a kernel");
    context_->use();
    auto& state = context_->state();
    state.beforeLaunch();
    // Before the slots, because a launch may change its own arguments for the next one.
    if (launch.arguments != nullptr) state.bindArguments(glBuffer(*launch.arguments).id());
    bindBuffers(state, kernel, launch);
    state.useProgram(kernel.program());
    if (launch.arguments != nullptr) {
        checkRange("launch arguments", *launch.arguments, launch.argumentsOffset, 16);
        kernel.setUniforms(launch.phase, countInBuffer);
        glDispatchComputeIndirect(static_cast<GLintptr>(launch.argumentsOffset));
    } else {
        if (launch.count == 0) return;
        kernel.setUniforms(launch.phase, launch.count);
        dispatch(kernel.groupsOf(launch.count));
    }
    state.afterLaunch();
    fences_.launched();
}

std::unique_ptr<ReadBack> GlDevice::startReadBack(const Buffer& buffer, std::size_t bytes) {
    checkRange("read back", buffer, 0, bytes);
    context_->use();
    return readBacks_->start(glBuffer(buffer).id(), bytes);
}

std::unique_ptr<WordQueue> GlDevice::createWordQueue() {
    context_->use();
    return std::make_unique<GlWordQueue>(context_);
}

void GlDevice::beginTimer(unsigned slot) {
    if (!timersUsed_) return;
    context_->use();
    timers_.begin(slot);
}

void GlDevice::endTimer() {
    if (!timersUsed_) return;
    context_->use();
    timers_.end();
}

std::vector<double> GlDevice::takeTimes() {
    context_->use();
    return timers_.take();
}

void GlDevice::finish() {
    context_->use();
    fences_.wait();
    uploadsUsed_ = 0;
}

Result<void> GlDevice::status() {
    if (const char* const cause = context_->resetCause())
        return fail(ErrorKind::DeviceLost, info_.renderer, fmt::format("the device was reset: {}", cause));
    if (copiesFail_)
        return fail(ErrorKind::DeviceLost, info_.renderer,
                    "the driver has no host memory left for copies; start again");
    return {};
}

}  // namespace spherule::compute::gl

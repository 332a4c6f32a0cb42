#pragma once

#include <memory>
#include <string>
#include <vector>

#include "compute/device.h"
#include "compute/gl/context.h"
#include "compute/gl/fences.h"
#include "compute/gl/open_context.h"
#include "compute/gl/read_back.h"
#include "compute/gl/staging.h"
#include "compute/gl/timers.h"

namespace spherule::compute::gl {

// Device on OpenGL compute. Buffers, kernels and read-backs may outlive it.
class GlDevice final : public Device {
  public:
    explicit GlDevice(const Opened& opened);

    [[nodiscard]] const DeviceInfo& info() const override { return info_; }
    Result<std::unique_ptr<Buffer>> createBuffer(std::string_view label, std::size_t bytes,
                                                 std::string_view words) override;
    [[nodiscard]] std::uint64_t hostBytes(std::uint64_t bytes, std::string_view words) const override;
    Result<std::unique_ptr<Kernel>> createKernel(const SourceSet& sources, std::string_view file,
                                                 std::span<const Define> defines) override;
    void upload(Buffer& buffer, std::size_t offset, std::span<const std::byte> bytes) override;
    void download(const Buffer& buffer, std::size_t offset, std::span<std::byte> bytes) override;
    void fill(Buffer& buffer, std::uint32_t value) override;
    void copy(const Buffer& from, std::size_t fromOffset, std::size_t bytes, Buffer& to, std::size_t toOffset) override;
    void launch(const Launch& launch) override;
    std::unique_ptr<ReadBack> startReadBack(const Buffer& buffer, std::size_t bytes) override;
    std::unique_ptr<WordQueue> createWordQueue() override;
    void useTimers(bool use) override { timersUsed_ = use; }
    void beginTimer(unsigned slot) override;
    void endTimer() override;
    std::vector<double> takeTimes() override;
    void finish() override;
    [[nodiscard]] Result<void> status() override;

  private:
    std::shared_ptr<Context> context_;
    DeviceInfo info_;
    Fences fences_;
    Staging uploads_;
    std::size_t uploadsUsed_ = 0;  // bytes that the device may still have to read
    Staging downloads_;
    bool copiesFail_ = false;
    std::shared_ptr<ReadBackPlaces> readBacks_;
    Timers timers_;
    bool timersUsed_ = true;
};

}  // namespace spherule::compute::gl

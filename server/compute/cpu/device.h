#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "compute/cpu/kernels.h"
#include "compute/cpu/memory.h"
#include "compute/cpu/pool.h"
#include "compute/device.h"

namespace spherule::compute::cpu {

// Device on the CPU: runs the kernels that were compiled into the program, whatever sources it is given.
class CpuDevice final : public Device {
  public:
    CpuDevice(unsigned threads, Precision precision, const std::string& reason);

    [[nodiscard]] const DeviceInfo& info() const override { return info_; }
    Result<std::unique_ptr<Buffer>> createBuffer(std::string_view label, std::size_t bytes,
                                                 std::string_view words) override;
    [[nodiscard]] std::uint64_t hostBytes(std::uint64_t bytes, std::string_view words) const override;
    Result<std::unique_ptr<Kernel>> createKernel(const SourceSet& sources, std::string_view file,
                                                 std::span<const Define> defines) override;
    void upload(Buffer& buffer, std::size_t offset, std::span<const std::byte> bytes) override;
    void download(const Buffer& buffer, std::size_t offset, std::span<std::byte> bytes) override;
    void fill(Buffer& buffer, std::uint32_t value) override;
    void launch(const Launch& launch) override;
    std::unique_ptr<ReadBack> startReadBack(const Buffer& buffer, std::size_t bytes) override;
    void beginTimer(unsigned slot) override;
    void endTimer() override;
    std::vector<double> takeTimes() override;
    void finish() override {}
    [[nodiscard]] Result<void> status() override { return {}; }

  private:
    Precision precision_;
    DeviceInfo info_;
    Pool pool_;
    std::shared_ptr<int> readBacks_ = std::make_shared<int>(0);  // under way
    std::vector<double> seconds_;                                // by timer slot
    unsigned timed_ = 0;
    std::chrono::steady_clock::time_point began_;
};

// Whether a choice that is no OpenGL device, or "auto" where there is none, means this one.
bool answersTo(const std::string& choice);

// "cpu", "cpu:N" (N threads, 1 to 256) or "cpu-double", "cpu-double:N", or "auto"; Input for anything else. Without N
// as many threads as this process may use processors. `passedOver`: why OpenGL was not taken.
Result<std::unique_ptr<Device>> openDevice(const std::string& choice, const std::string& passedOver);

}  // namespace spherule::compute::cpu

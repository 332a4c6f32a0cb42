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

// Device on the CPU. Runs the kernels that were compiled into the program, and ignores the sources passed to it.
class CpuDevice final : public Device {
  public:
    CpuDevice(unsigned threads, Precision precision, unsigned lanes, const std::string& reason);

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
    void finish() override {}
    [[nodiscard]] Result<void> status() override { return {}; }

  private:
    Precision precision_;
    unsigned lanes_;  // 1, 4, 8 or 16: pairs or spheres that a thread handles at once
    DeviceInfo info_;
    Pool pool_;
    std::shared_ptr<int> readBacks_ = std::make_shared<int>(0);  // under way
    std::vector<double> seconds_;                                // by timer slot
    unsigned timed_ = 0;
    bool timersUsed_ = true;
    std::chrono::steady_clock::time_point began_;
};

// Returns true if `choice` means the CPU device. That includes "auto", if there is no OpenGL device.
bool answersTo(const std::string& choice);

// Opens "cpu", "cpu:N" (N threads, 1 to 256), "cpu:NxL" (L lanes: 1, 4, 8 or 16), "cpu-double", "cpu-double:N" or
// "auto"; Input for anything else. Without N, one thread per processor that this process may use. Without L, or if the
// processor has no vectors of L numbers, as many lanes as its vectors hold. `passedOver`: reason why OpenGL was not
// used.
Result<std::unique_ptr<Device>> openDevice(const std::string& choice, const std::string& passedOver);

}  // namespace spherule::compute::cpu

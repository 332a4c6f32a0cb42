#include "compute/cpu/device.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>

#include <spdlog/fmt/fmt.h>

#include "compute/check.h"
#include "compute/cpu/features.h"
#include "compute/cpu/host.h"
#include "core/heartbeat.h"

namespace spherule::compute::cpu {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int maxReadBacks = 2;
// Each thread takes ranges one at a time. There are few enough that taking them costs little, and enough that the
// threads end together.
constexpr std::uint32_t rangesPerThread = 16;

const CpuBuffer& cpuBuffer(const Buffer& buffer) {
    return static_cast<const CpuBuffer&>(buffer);
}

class CpuKernel final : public Kernel {
  public:
    CpuKernel(const Entry& entry, std::uint64_t features)
        : entry_(entry), features_(features), name_(std::string(entry.name)) {}
    [[nodiscard]] const std::string& name() const override { return name_; }
    [[nodiscard]] const Entry& entry() const { return entry_; }
    [[nodiscard]] std::span<const BufferDeclaration> buffers() const override { return entry_.buffers; }
    [[nodiscard]] std::uint64_t features() const { return features_; }

  private:
    const Entry& entry_;
    std::uint64_t features_;
    std::string name_;
};

class CpuReadBack final : public ReadBack {
  public:
    CpuReadBack(std::vector<std::byte> bytes, std::shared_ptr<int> underWay)
        : bytes_(std::move(bytes)), underWay_(std::move(underWay)) {
        ++*underWay_;
    }
    ~CpuReadBack() override { --*underWay_; }
    CpuReadBack(const CpuReadBack&) = delete;
    CpuReadBack& operator=(const CpuReadBack&) = delete;
    std::optional<std::span<const std::byte>> poll() override { return bytes_; }

  private:
    std::vector<std::byte> bytes_;
    std::shared_ptr<int> underWay_;
};

class CpuWordQueue final : public WordQueue {
  public:
    void start(const Buffer& buffer, std::size_t offset) override {
        checkRange("copy of a word", buffer, offset, sizeof(std::uint32_t));
        if (words_.size() == most) programError("too many words are under way");
        std::uint32_t word = 0;
        const CpuBuffer& from = cpuBuffer(buffer);
        from.words().load(from.data(), offset, std::as_writable_bytes(std::span(&word, 1)));
        words_.push_back(word);
    }
    [[nodiscard]] std::size_t underWay() const override { return words_.size(); }
    std::uint32_t take() override {
        if (words_.empty()) programError("no word is under way");
        const std::uint32_t word = words_.front();
        words_.pop_front();
        return word;
    }

  private:
    std::deque<std::uint32_t> words_;
};

std::uint64_t featuresOf(std::span<const Define> defines) {
    std::uint64_t features = 0;
    for (const Define& define : defines) {
        const auto* const found = std::ranges::find(featureNames, define.name);
        if (found != std::end(featureNames) && define.value == "true")
            features |= std::uint64_t{1} << static_cast<unsigned>(found - std::begin(featureNames));
    }
    return features;
}

// Returns null if there is no such kernel.
const Entry* entryOf(std::string_view file, Precision precision, unsigned lanes) {
    std::vector<std::span<const Entry>> tables;
    if (lanes == 4) tables.push_back(kernelsWith4Lanes());
    if (lanes == 8) tables.push_back(kernelsWith8Lanes());
    if (lanes == 16) tables.push_back(kernelsWith16Lanes());
    tables.push_back(precision == Precision::Double ? doubleKernels() : floatKernels());
    for (const auto& table : tables) {
        const auto found = std::ranges::find(table, file, &Entry::name);
        if (found != table.end()) return &*found;
    }
    return nullptr;
}

std::uint32_t countOf(const Launch& launch) {
    if (launch.arguments == nullptr) return launch.count;
    checkRange("launch arguments", *launch.arguments, launch.argumentsOffset, 16);
    std::array<std::uint32_t, 4> row{};
    std::memcpy(row.data(), cpuBuffer(*launch.arguments).data() + launch.argumentsOffset, sizeof row);
    return row[0] == 0 ? 0 : row[3];
}

struct Work {
    const Entry& entry;
    Binding binding;
};

void runRange(const void* work, std::uint32_t begin, std::uint32_t end) {
    const auto& [entry, binding] = *static_cast<const Work*>(work);
    entry.run(binding, begin, end);
}

}  // namespace

CpuDevice::CpuDevice(unsigned threads, Precision precision, unsigned lanes, const std::string& reason)
    : precision_(precision), lanes_(lanes), pool_(threads) {
    info_.kind = "cpu";
    info_.renderer = fmt::format(
        "{}, {} thread{}, {}", processorName(), threads, threads == 1 ? "" : "s",
        precision == Precision::Double ? "double precision" : fmt::format("{} lane{}", lanes, lanes == 1 ? "" : "s"));
    info_.vendor = "Spherule";
    info_.version = "kernels compiled as C++";
    info_.reason = reason;
    info_.maxBufferBytes = memoryBytes();
    info_.robust = true;  // it cannot be lost
}

Result<std::unique_ptr<Buffer>> CpuDevice::createBuffer(std::string_view label, std::size_t bytes,
                                                        std::string_view words) {
    heartbeat::beat("making room in memory");
    return CpuBuffer::create(label, bytes, Words(words, precision_));
}

std::uint64_t CpuDevice::hostBytes(std::uint64_t bytes, std::string_view words) const {
    return Words(words, precision_).bytesFor(bytes);
}

Result<std::unique_ptr<Kernel>> CpuDevice::createKernel(const SourceSet& /*sources*/, std::string_view file,
                                                        std::span<const Define> defines) {
    const Entry* const found = entryOf(file, precision_, lanes_);
    if (found == nullptr) {
        return fail(ErrorKind::Input, std::string(file),
                    "is not among the kernels that this program has as C++; use --device software");
    }
    return std::make_unique<CpuKernel>(*found, featuresOf(defines));
}

void CpuDevice::upload(Buffer& buffer, std::size_t offset, std::span<const std::byte> bytes) {
    checkRange("upload", buffer, offset, bytes.size());
    const CpuBuffer& to = cpuBuffer(buffer);
    to.words().store(to.data(), offset, bytes);
}

void CpuDevice::download(const Buffer& buffer, std::size_t offset, std::span<std::byte> bytes) {
    checkRange("download", buffer, offset, bytes.size());
    const CpuBuffer& from = cpuBuffer(buffer);
    from.words().load(from.data(), offset, bytes);
}

void CpuDevice::fill(Buffer& buffer, std::uint32_t value) {
    // Fills in parts: values for the whole buffer would need as much memory again.
    constexpr std::size_t most = 1U << 16U;
    const std::vector<std::uint32_t> values(std::min(buffer.bytes() / sizeof value, most), value);
    for (std::size_t first = 0; first < buffer.bytes(); first += most * sizeof value) {
        const std::size_t bytes = std::min(most * sizeof value, buffer.bytes() - first);
        upload(buffer, first, std::as_bytes(std::span(values)).first(bytes));
    }
}

void CpuDevice::copy(const Buffer& from, std::size_t fromOffset, std::size_t bytes, Buffer& to, std::size_t toOffset) {
    checkRange("copy", from, fromOffset, bytes);
    checkRange("copy", to, toOffset, bytes);
    const CpuBuffer& source = cpuBuffer(from);
    const CpuBuffer& target = cpuBuffer(to);
    const std::size_t begin = source.words().bytesFor(fromOffset);
    std::memcpy(target.data() + target.words().bytesFor(toOffset), source.data() + begin,
                source.words().bytesFor(fromOffset + bytes) - begin);
}

void CpuDevice::launch(const Launch& launch) {
    if (launch.kernel == nullptr) programError("a launch without a kernel");
    const auto& kernel = static_cast<const CpuKernel&>(*launch.kernel);
    const Entry& entry = kernel.entry();
    // Clearing it would make `billiards` slower by a third. NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
    std::array<void*, maxKernelBuffers> slots;
    for (std::size_t slot = 0; slot < entry.buffers.size(); ++slot) {
        const Buffer* const buffer = slot < launch.buffers.size() ? launch.buffers[slot] : nullptr;
        if (buffer == nullptr)
            programError(fmt::format("{} is launched without its buffer {}", kernel.name(), entry.buffers[slot].name));
        slots[slot] = cpuBuffer(*buffer).data();
    }
    if (entry.wantsParameters && launch.parameters == nullptr)
        programError(kernel.name() + " is launched without its parameters");
    const Work work{.entry = entry,
                    .binding = {.slots = std::span(slots.data(), entry.buffers.size()),
                                .parameters = entry.wantsParameters ? cpuBuffer(*launch.parameters).data() : nullptr,
                                .phase = launch.phase,
                                .features = kernel.features()}};
    heartbeat::beat(entry.name);
    const std::uint32_t wanted = countOf(launch);
    if (wanted == 0) return;
    const std::uint32_t count = std::min(wanted, entry.count(work.binding));
    const std::uint32_t range = count / (pool_.threads() * rangesPerThread) / entry.smallestRange * entry.smallestRange;
    pool_.run(count, std::max(entry.smallestRange, range), runRange, &work);
}

std::unique_ptr<ReadBack> CpuDevice::startReadBack(const Buffer& buffer, std::size_t bytes) {
    checkRange("read back", buffer, 0, bytes);
    if (*readBacks_ >= maxReadBacks) return nullptr;
    std::vector<std::byte> copy(bytes);
    download(buffer, 0, copy);
    return std::make_unique<CpuReadBack>(std::move(copy), readBacks_);
}

std::unique_ptr<WordQueue> CpuDevice::createWordQueue() {
    return std::make_unique<CpuWordQueue>();
}

void CpuDevice::beginTimer(unsigned slot) {
    if (!timersUsed_) return;
    timed_ = slot;
    if (seconds_.size() <= slot) seconds_.resize(slot + 1);
    began_ = Clock::now();
}

void CpuDevice::endTimer() {
    if (!timersUsed_) return;
    seconds_[timed_] += std::chrono::duration<double>(Clock::now() - began_).count();
}

std::vector<double> CpuDevice::takeTimes() {
    return std::exchange(seconds_, {});
}

}  // namespace spherule::compute::cpu

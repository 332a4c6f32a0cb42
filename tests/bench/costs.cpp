#include "costs.h"

#include <chrono>
#include <functional>

#include "baseline.h"
#include "stopwatch.h"

namespace spherule::bench {

namespace {

const std::string table = "Costs of launches, each, and of copies";
constexpr unsigned rounds = 5;

double seconds(compute::Device& device, const std::function<void()>& work) {
    device.finish();
    const auto begin = std::chrono::steady_clock::now();
    work();
    device.finish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

class Launches {
  public:
    Launches(compute::Device& device, unsigned count, Figures& figures)
        : device_(device), count_(count), figures_(figures) {}

    // `timed`: with a timer around each launch instead of one around all.
    void measure(const std::string& what, const compute::Launch& launch, bool timed) {
        std::vector<double> wall, onDevice;
        for (unsigned round = 0; round < rounds; ++round) {
            device_.takeTimes();
            wall.push_back(seconds(device_, [&] { launchAll(launch, timed); }));
            onDevice.push_back(device_.takeTimes().at(0));
        }
        add(what + ", device time", median(onDevice));
        add(what + ", wall time", median(wall));
    }

  private:
    void launchAll(const compute::Launch& launch, bool timed) {
        if (!timed) device_.beginTimer(0);
        for (unsigned k = 0; k < count_; ++k) {
            if (timed) device_.beginTimer(0);
            device_.launch(launch);
            if (timed) device_.endTimer();
        }
        if (!timed) device_.endTimer();
    }

    void add(const std::string& what, double all) {
        figures_.push_back({table, count_, what, all / count_ * 1e6, "us", ""});
    }

    compute::Device& device_;
    unsigned count_;
    Figures& figures_;
};

void addCopies(compute::Device& device, compute::Buffer& buffer, Figures& figures) {
    std::vector<std::byte> host(buffer.bytes());
    std::vector<double> up, down;
    for (unsigned round = 0; round < rounds; ++round) {
        up.push_back(seconds(device, [&] { device.upload(buffer, 0, host); }));
        down.push_back(seconds(device, [&] { device.download(buffer, 0, host); }));
    }
    const auto add = [&](const std::string& what, double time) {
        figures.push_back({table, 1, what, static_cast<double>(host.size()) / time * 1e-9, "GB/s",
                           std::to_string(host.size() >> 20U) + " MiB"});
    };
    add("copy to the device", median(up));
    add("copy from the device", median(down));
}

}  // namespace

Result<void> deviceCosts(compute::Device& device, bool quick, Figures& figures) {
    // With the phase 0 it does nothing.
    const auto kernel = device.createKernel(benchSources(), "clear.comp", {});
    if (!kernel) return tl::unexpected(kernel.error());
    const auto words = device.createBuffer("words", std::size_t{quick ? 1U : 64U} << 20U);
    if (!words) return tl::unexpected(words.error());
    const auto arguments = device.createBuffer("arguments", 16);
    if (!arguments) return tl::unexpected(arguments.error());
    device.fill(**arguments, 0);

    compute::Buffer* const bound[] = {words->get()};
    compute::Launch launch{.kernel = kernel->get(), .buffers = bound, .count = 64};
    Launches launches(device, quick ? 100 : 4000, figures);
    launches.measure("one group", launch, false);
    launches.measure("one group, a timer each", launch, true);
    launch.count = 64 * 16'000;
    launches.measure("16,000 groups", launch, false);
    launch.arguments = arguments->get();
    launches.measure("indirect, no groups", launch, false);
    addCopies(device, **words, figures);
    return device.status();
}

}  // namespace spherule::bench

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "app/dump.h"
#include "app/duration.h"
#include "app/exit_codes.h"
#include "app/options.h"
#include "app/run_report.h"
#include "compute/device.h"
#include "sim/simulation.h"

namespace spherule::app {

namespace {

struct RunOptions {
    SceneOptions scene;
    std::string duration;
    std::string every;
    std::string dump;
    bool json = false;
};

using Clock = std::chrono::steady_clock;
constexpr double mostSteps = 1e12;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// A line on the terminal that is rewritten a few times a second; silent elsewhere.
class Progress {
  public:
    explicit Progress(std::uint64_t steps) : steps_(steps), shown_(isatty(STDERR_FILENO) != 0) {}
    ~Progress() {
        if (shown_ && printed_) std::fputc('\n', stderr);
    }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void at(std::uint64_t step, double simulated) {
        if (!shown_ || secondsSince(last_) < 0.2) return;
        last_ = Clock::now();
        printed_ = true;
        fmt::print(stderr, "\r{} of {} steps, {:.2f} s simulated, {:.2f} times real time ", step, steps_, simulated,
                   simulated / secondsSince(start_));
    }

  private:
    std::uint64_t steps_;
    bool shown_;
    bool printed_ = false;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_ = start_;
};

Result<RunTimes> runSteps(sim::Simulation& simulation, compute::Device& device, double duration, double every,
                          Dump* dump) {
    const double step = simulation.scene().step;
    const auto steps = static_cast<std::uint64_t>(std::llround(duration / step));
    const auto stride = every > 0 ? std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(every / step)))
                                  : std::max<std::uint64_t>(1, steps);
    if (dump != nullptr)
        if (auto done = dump->write(simulation); !done) return tl::unexpected(done.error());
    Progress progress(steps);
    RunTimes times;
    const auto start = Clock::now();
    for (std::uint64_t k = 1; k <= steps; ++k) {
        if (auto done = simulation.step(); !done) return tl::unexpected(done.error());
        progress.at(k, simulation.time());
        if (dump != nullptr && (k % stride == 0 || k == steps))
            if (auto done = dump->write(simulation); !done) return tl::unexpected(done.error());
    }
    device.finish();
    times.wallSeconds = secondsSince(start);
    for (const double seconds : device.takeTimes()) times.deviceSeconds += seconds;
    return times;
}

Result<void> run(const RunOptions& options) {
    const auto duration = secondsOf(options.duration, "--for");
    if (!duration) return tl::unexpected(duration.error());
    const auto every = options.every.empty() ? Result<double>(0.0) : secondsOf(options.every, "--every");
    if (!every) return tl::unexpected(every.error());
    if (!options.every.empty() && !(*every > 0)) return fail(ErrorKind::Input, "--every", "must be above 0");
    if (!options.every.empty() && options.dump.empty())
        return fail(ErrorKind::Input, "--every", "says how often to dump; name the file with --dump");

    auto device = compute::openDevice(options.scene.device);
    if (!device) return tl::unexpected(device.error());
    auto loaded = scene::load(options.scene.scene, (*device)->info().kind, options.scene.overrides);
    if (!loaded) return tl::unexpected(loaded.error());
    if (!(*duration / loaded->step <= mostSteps))
        return fail(ErrorKind::Input, "--for",
                    fmt::format("is {:g} steps, at most {:g} are allowed", *duration / loaded->step, mostSteps));
    auto simulation = sim::Simulation::create(**device, std::move(*loaded));
    if (!simulation) return tl::unexpected(simulation.error());
    std::optional<Dump> dump;
    if (!options.dump.empty()) {
        auto created = Dump::create(options.dump);
        if (!created) return tl::unexpected(created.error());
        dump = std::move(*created);
    }
    const auto times = runSteps(**simulation, **device, *duration, *every, dump ? &*dump : nullptr);
    if (!times) return tl::unexpected(times.error());
    const auto& info = (*device)->info();
    if (options.json)
        fmt::print("{}\n", runJson(info, **simulation, *times));
    else
        fmt::print("{}", runText(info, **simulation, *times));
    return {};
}

}  // namespace

void addRun(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<RunOptions>();
    CLI::App* command = app.add_subcommand("run", "simulate as fast as it goes, without the network");
    options->scene.addTo(*command);
    command->add_option("--for", options->duration, "simulated time, such as 2s")->required();
    command->add_option("--every", options->every, "dump a state this often; absent: the first and the last");
    command->add_option("--dump", options->dump, "write states to this CSV file");
    command->add_flag("--json", options->json, "print one line of JSON");
    command->footer(exitCodesText);
    command->callback([options, &exitCode] {
        const auto done = run(*options);
        exitCode = done ? exitDone : report(done.error());
    });
}

}  // namespace spherule::app

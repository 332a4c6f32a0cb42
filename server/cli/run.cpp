#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "checkpoint/keeper.h"
#include "cli/checkpoint_options.h"
#include "cli/errors.h"
#include "cli/exit_codes.h"
#include "cli/force_table.h"
#include "cli/interrupt.h"
#include "cli/option_values.h"
#include "cli/options.h"
#include "cli/progress_line.h"
#include "cli/record_options.h"
#include "cli/run_files.h"
#include "cli/run_report.h"
#include "cli/script.h"
#include "cli/state_dump.h"
#include "compute/device.h"
#include "core/archive.h"
#include "core/log.h"
#include "diagnostics/overlap_watch.h"
#include "diagnostics/substep_controller.h"
#include "host/resume.h"
#include "host/run_recorder.h"
#include "host/watchdog.h"
#include "sim/simulation.h"

namespace spherule::cli {

namespace {

struct RunOptions {
    SceneOptions scene;
    recording::Options record;
    checkpoint::Options checkpoints;
    std::string duration;
    std::string every;
    std::string dump;
    std::string surfaceForces;
    std::string script;
    double watchdog = 0;
    bool json = false;
};

using Clock = std::chrono::steady_clock;
constexpr double mostSteps = 1e12;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Measures a run in intervals. The time of reports between two intervals is not counted. The time of dumps is.
class IntervalTimer {
  public:
    IntervalTimer(sim::Simulation& simulation, compute::Device& device) : simulation_(simulation), device_(device) {
        start();
    }

    void start() {
        static_cast<void>(device_.takeTimes());
        simTime_ = simulation_.time();
        rebuilds_ = simulation_.counters().rebuilds;
        launches_ = simulation_.pipeline().launches();
        impacts_ = simulation_.impacts();
        sums_ = simulation_.readContactSums();
        began_ = Clock::now();
    }
    // Waits for the device.
    Interval take() {
        device_.finish();
        Interval interval{.simSeconds = simulation_.time() - simTime_,
                          .wallSeconds = secondsSince(began_),
                          .passSeconds = device_.takeTimes(),
                          .rebuilds = since(rebuilds_, simulation_.counters().rebuilds),
                          .launches = since(launches_, simulation_.pipeline().launches()),
                          .before = impacts_};
        interval.end = simulation_.statistics();
        if (const auto& sums = interval.end.contactSums)
            sim::setMeans(interval.end, sums->since(sums_), simulation_.scene());
        return interval;
    }

  private:
    // A command that makes other arrays begins the count anew.
    static std::uint64_t since(std::uint64_t before, std::uint64_t now) { return now >= before ? now - before : now; }

    sim::Simulation& simulation_;
    compute::Device& device_;
    double simTime_ = 0;
    std::uint64_t rebuilds_ = 0;
    std::uint64_t launches_ = 0;
    sim::Impacts impacts_;
    sim::ContactSums sums_;
    Clock::time_point began_;
};

// Completes a step. Returns false if a signal asks for the end and the step takes longer than `wholeStep`: the step is
// incomplete then.
Result<bool> stepUnlessAsked(sim::Simulation& simulation, const Interrupt& interrupt) {
    constexpr double wholeStep = 0.5;  // s; a shorter step is always completed
    const auto began = Clock::now();
    for (;;) {
        const auto ended = simulation.advance();
        if (!ended || *ended) return ended;
        if (interrupt.asked() && secondsSince(began) > wholeStep) return false;
    }
}

// Runs to step `steps`, or less far after a signal. Calls `every` after each `stride` steps and at the end, before the
// commands of the script that are due at that step. `recorder` may be null.
Result<void> runSteps(sim::Simulation& simulation, Script& script, host::RunRecorder* recorder,
                      const Interrupt& interrupt, std::uint64_t steps, std::uint64_t stride, const RunFiles& files,
                      const std::function<Result<void>()>& every) {
    ProgressLine progress;
    const auto began = Clock::now();
    const double beganAt = simulation.time();
    diagnostics::SubstepController& controller = files.controller;
    checkpoint::Keeper& keeper = files.keeper;
    const auto record = [recorder](v1::Event::Kind kind, const std::string& text) {
        return recorder != nullptr ? recorder->addEvent(kind, text) : Result<void>();
    };
    std::uint64_t k = simulation.steps();
    for (bool last = false; !last;) {
        if (!simulation.midStep()) {
            const auto applied = script.applyDue(simulation, [&](const v1::Command& command) {
                keeper.logCommand(checkpoint::placeOf(simulation), 0, command);
            });
            if (!applied) return tl::unexpected(applied.error());
            if (*applied) controller.reset();
        }
        const auto ended = stepUnlessAsked(simulation, interrupt);
        if (!ended) return tl::unexpected(ended.error());
        if (*ended) ++k;
        last = k == steps || interrupt.asked();
        for (const std::string& notice : simulation.takeNotices()) {
            spdlog::warn("{}", notice);
            if (auto done = record(v1::Event::WARNING, notice); !done) return done;
        }
        const std::uint32_t substeps = simulation.scene().quality.substeps;
        const auto message = controller.stepped(simulation, 0);  // `run` accepts no goal for the wall time
        if (!message) return tl::unexpected(message.error());
        if (simulation.scene().quality.substeps != substeps)
            keeper.logSubsteps(checkpoint::placeOf(simulation), simulation.scene().quality.substeps);
        if (*message) {
            spdlog::info("at step {}, {}", simulation.steps(), **message);
            if (auto done = record(v1::Event::TUNED, **message); !done) return done;
        }
        if (simulation.counters().nonFinite)
            return fail(ErrorKind::Diverged, "", simulation.divergence() + "; use more substeps or another model");
        if (recorder != nullptr)
            if (auto done = recorder->stepped(last); !done) return done;
        if (*ended) files.stepped(simulation);
        progress.show([&] {
            return fmt::format("{} of {} steps, {:.2f} s simulated, {:.2f} times real time ", k, steps,
                               simulation.time(), (simulation.time() - beganAt) / secondsSince(began));
        });
        if (k % stride == 0 || last)
            if (auto done = every(); !done) return done;
    }
    if (k < steps)
        spdlog::warn("ended early by {}, at step {}, {:g} s simulated", interrupt.name(), simulation.steps(),
                     simulation.time());
    return {};
}

void print(const RunOptions& options, const compute::DeviceInfo& info, sim::Simulation& simulation,
           const Interval& interval) {
    if (options.json)
        fmt::print("{}\n", runJson(info, simulation, interval));
    else if (options.every.empty() || !options.dump.empty())
        fmt::print("{}", runText(info, simulation, interval));
    else
        fmt::print("{}", runRow(simulation, interval));
    std::fflush(stdout);
}

// Duration of the run and interval of reports (s simulated).
struct Times {
    double duration = 0;
    double every = 0;  // 0: one report at the end
};

// Output files.
struct Outputs {
    std::optional<StateDump> dump;
    std::optional<ForceTable> forces;
    std::unique_ptr<host::RunRecorder> recorder;
};

Result<void> simulate(const RunOptions& options, sim::Simulation& simulation, Script& script, compute::Device& device,
                      Outputs& outputs, const Interrupt& interrupt, const RunFiles& files, Times times) {
    const double step = simulation.scene().step;
    const double every = times.every;
    const auto steps = static_cast<std::uint64_t>(std::llround(times.duration / step));
    const auto stride = every > 0 ? std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(every / step)))
                                  : std::max<std::uint64_t>(1, steps);
    IntervalTimer timer(simulation, device);
    host::RunRecorder* const recorder = outputs.recorder.get();
    const auto writeForces = [&] { return outputs.forces ? outputs.forces->write(simulation) : Result<void>(); };
    if (!outputs.dump) {
        if (every > 0 && !options.json) fmt::print("{}\n", runRowHeader);
        diagnostics::OverlapWatch overlap;
        const auto report = [&]() -> Result<void> {
            const Interval interval = timer.take();
            if (const auto alarm = overlap.check(simulation.steps(), interval.end.deepest()))
                spdlog::warn("{}", *alarm);
            print(options, device.info(), simulation, interval);
            auto done = writeForces();
            timer.start();
            return done;
        };
        if (steps <= simulation.steps()) return report();
        return runSteps(simulation, script, recorder, interrupt, steps, stride, files, report);
    }
    StateDump& dump = *outputs.dump;
    const auto write = [&] {
        auto done = dump.write(simulation);
        return done ? writeForces() : done;
    };
    if (auto done = write(); !done) return done;
    if (steps > simulation.steps())
        if (auto done = runSteps(simulation, script, recorder, interrupt, steps, stride, files, write); !done)
            return done;
    print(options, device.info(), simulation, timer.take());
    return {};
}

Result<Outputs> openOutputs(const RunOptions& options, sim::Simulation& simulation, const Script& script,
                            compute::Device& device, Times times) {
    Outputs outputs;
    if (!options.dump.empty()) {
        auto dump = StateDump::create(options.dump, options.record.replace);
        if (!dump) return tl::unexpected(dump.error());
        outputs.dump.emplace(std::move(*dump));
    }
    if (!options.surfaceForces.empty()) {
        auto forces = ForceTable::create(options.surfaceForces, options.record.replace);
        if (!forces) return tl::unexpected(forces.error());
        outputs.forces.emplace(std::move(*forces));
    }
    if (!options.record.path.empty()) {
        const std::string plan = fmt::format("{}\n{}", times.duration, script.text());
        auto recorder = host::RunRecorder::create(options.record, device, simulation, plan);
        if (!recorder) return tl::unexpected(recorder.error());
        outputs.recorder = std::move(*recorder);
    }
    return outputs;
}

// Opens the output files and runs the simulation. The recording is finished even if the run has failed.
Result<void> simulateInto(const RunOptions& options, sim::Simulation& simulation, Script& script,
                          compute::Device& device, Interrupt& interrupt, const RunFiles& files, Times times) {
    interrupt.finishFirst();
    auto outputs = openOutputs(options, simulation, script, device, times);
    if (!outputs) return tl::unexpected(outputs.error());
    Result<void> done;
    if (outputs->recorder && options.record.log)
        done = files.keeper.beginLogInRecording(simulation, files.head(), outputs->recorder->logSink());
    if (done) done = simulate(options, simulation, script, device, *outputs, interrupt, files, times);
    files.finish(simulation, done);
    if (outputs->recorder) {
        auto finished = outputs->recorder->finish();
        if (done) done = finished;
    }
    if (outputs->dump && done) done = outputs->dump->finish();
    if (outputs->forces && done) done = outputs->forces->finish();
    if (done && outputs->recorder) {
        const recording::Writer& writer = outputs->recorder->writer();
        spdlog::info("recorded {} frames in {}, {:.1f} MB", writer.frames(), options.record.path,
                     1e-6 * static_cast<double>(writer.bytes()));
    }
    return done;
}

Result<void> checkFiles(const RunOptions& options) {
    const std::array<std::pair<const char*, const std::string&>, 4> files{{{"--record", options.record.path},
                                                                           {"--dump", options.dump},
                                                                           {"--surface-forces", options.surfaceForces},
                                                                           {"--log", options.checkpoints.log}}};
    if (options.record.replace && std::ranges::all_of(files, [](const auto& file) { return file.second.empty(); }))
        return fail(ErrorKind::Input, "--force",
                    "has nothing to replace; give --record, --dump, --surface-forces or --log");
    for (std::size_t k = 0; k < files.size(); ++k) {
        const auto& [option, path] = files[k];
        if (path == "-")
            return fail(ErrorKind::Input, option, "cannot be standard output, where the report goes; give it a file");
        for (std::size_t other = 0; other < k; ++other)
            if (!path.empty() && path == files[other].second)
                return fail(ErrorKind::Input, option,
                            fmt::format("is the file of {}; give each its own", files[other].first));
    }
    return {};
}

// Begins with the scene. Refuses what is certain to fail in a run of `duration` seconds.
Result<std::unique_ptr<sim::Simulation>> begin(const RunOptions& options, const Script& script, compute::Device& device,
                                               double duration) {
    auto loaded = scene::load(options.scene.scene, device.info().kind, options.scene.overrides);
    if (!loaded) return tl::unexpected(loaded.error());
    if (loaded->quality.goal && loaded->quality.goal->kind == scene::QualityGoal::Kind::StepTime)
        return fail(ErrorKind::Input, "quality.auto",
                    "holds a time per step, so the result would depend on the load of the machine: give `run` an "
                    "overlap to hold, such as --auto 0.5%, or --substeps");
    if (auto fits = script.check(*loaded, duration); !fits) return tl::unexpected(fits.error());
    return sim::Simulation::create(device, std::move(*loaded));
}

Result<void> run(const RunOptions& options) {
    Interrupt interrupt;
    if (auto done = checkFiles(options); !done) return done;
    const auto duration = secondsOf(options.duration, "--for");
    if (!duration) return tl::unexpected(duration.error());
    const auto every = options.every.empty() ? Result<double>(0.0) : secondsOf(options.every, "--every");
    if (!every) return tl::unexpected(every.error());
    if (!options.every.empty() && !(*every > 0)) return fail(ErrorKind::Input, "--every", "must be above 0");

    auto script = options.script.empty() ? Result<Script>(Script()) : Script::read(options.script);
    if (!script) return tl::unexpected(script.error());

    // The watchdog outlives the device, whose destructor may hang.
    host::Watchdog watchdog{host::Watchdog::Seconds(options.watchdog)};
    watchdog.start([](const Error& error) { host::endNow(printError(error)); });
    auto device = compute::openDevice(options.scene.device);
    if (!device) return tl::unexpected(device.error());
    spdlog::info("on {}: {}", (*device)->info().renderer, (*device)->info().reason);
    auto keeper = checkpoint::Keeper::open(options.checkpoints);
    if (!keeper) return tl::unexpected(keeper.error());
    auto found = (*keeper)->resume(**device);
    if (!found) return tl::unexpected(found.error());
    auto& resumed = *found;
    auto simulation = resumed ? Result<std::unique_ptr<sim::Simulation>>(std::move(resumed->simulation))
                              : begin(options, *script, **device, *duration);
    if (!simulation) return tl::unexpected(simulation.error());
    if (!(*duration / (*simulation)->scene().step <= mostSteps))
        return fail(
            ErrorKind::Input, "--for",
            fmt::format("is {:g} steps, at most {:g} are allowed", *duration / (*simulation)->scene().step, mostSteps));
    diagnostics::SubstepController controller;
    const RunFiles files{**keeper, **device, *script, controller};
    if (resumed) {
        if (auto done = script->goOnAfter(resumed->head.script()); !done) return done;
        Loader tuning(resumed->head.tuning());
        controller.archive(tuning);
        if (!tuning.ok()) controller.reset();
        host::reportResumed(resumed->path, **simulation, options.scene.scene);
        if (!options.surfaceForces.empty() && !(*simulation)->scene().contactSums)
            return fail(ErrorKind::Input, "--surface-forces",
                        "needs contact sums, which the checkpoint does not have; leave it out, or begin anew");
    }
    if (auto done = (*keeper)->beginLog(**simulation, files.head(), resumed ? &*resumed : nullptr); !done) return done;
    host::releasePulls(**simulation, **keeper);
    return simulateInto(options, **simulation, *script, **device, interrupt, files,
                        {.duration = *duration, .every = *every});
}

}  // namespace

void addRun(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<RunOptions>();
    CLI::App* command = app.add_subcommand("run", "simulate as fast as possible, without the network");
    options->scene.addTo(*command);
    command->add_option("--for", options->duration, "simulated time, such as 2s")->required();
    command->add_option("--every", options->every, "interval of reports, or with --dump of states [once, at the end]");
    command->add_option("--dump", options->dump, "write states to this CSV file");
    command->add_option("--surface-forces", options->surfaceForces,
                        "write forces and torques on walls and obstacles to this CSV file, once in each interval");
    command->add_option("--script", options->script,
                        "carry out timed commands: lines such as 1.5s set gravity 0 0 -1.6");
    addRunRecording(*command, options->record);
    addCheckpoints(*command, options->checkpoints);
    addWatchdog(*command, options->watchdog);
    command->add_flag("--json", options->json, "print JSON, one line per report");
    command->footer(exitCodesText);
    command->callback([options, &exitCode] {
        options->checkpoints.replace = options->record.replace;
        if (!options->surfaceForces.empty()) options->scene.overrides.contactSums = true;
        const auto done = run(*options);
        exitCode = done ? exitDone : printError(done.error());
    });
}

}  // namespace spherule::cli

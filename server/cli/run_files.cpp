#include "cli/run_files.h"

#include "core/archive.h"
#include "core/log.h"

namespace spherule::cli {

namespace {

void warn(const Error& error) {
    spdlog::warn("no checkpoint could be written: {}", error.text());
}

}  // namespace

v1::StateHead RunFiles::head() const {
    v1::StateHead head;
    head.set_device(device.info().kind);
    head.set_renderer(device.info().renderer);
    head.set_speed(1);
    head.set_script(script.done());
    Saver tuning;
    controller.archive(tuning);
    head.set_tuning(tuning.take());
    return head;
}

void RunFiles::stepped(sim::Simulation& simulation) const {
    keeper.logStep(simulation);
    report();
    const auto now = checkpoint::Keeper::Clock::now();
    keeper.flushLogs(now);
    if (!keeper.due(now)) return;
    if (auto begun = keeper.save(simulation, head(), now); !begun) warn(begun.error());
}

void RunFiles::finish(sim::Simulation& simulation, const Result<void>& run) const {
    keeper.wait();
    report();
    if (run && keeper.hasFolder() && simulation.midStep())
        spdlog::warn("the run was ended within a step: the last checkpoint is the one before");
    if (run && keeper.hasFolder() && !simulation.midStep())
        if (auto begun = keeper.save(simulation, head(), checkpoint::Keeper::Clock::now()); !begun) warn(begun.error());
    if (run || run.error().kind != ErrorKind::DeviceLost) {
        keeper.endLog(simulation);
        keeper.endLogInRecording(simulation);
    }
    keeper.wait();
    report();
    keeper.dropLogInRecording();
}

void RunFiles::report() const {
    for (const checkpoint::Keeper::Outcome& outcome : keeper.takeOutcomes()) {
        if (outcome.written)
            spdlog::info("checkpoint {} of step {}: {:.1f} MB in {:.2f} s", outcome.written->path, outcome.step,
                         1e-6 * static_cast<double>(outcome.written->bytes), outcome.seconds);
        else
            warn(outcome.written.error());
    }
    for (const Error& failure : keeper.takeLogFailures()) spdlog::warn("the command log has ended: {}", failure.text());
}

}  // namespace spherule::cli

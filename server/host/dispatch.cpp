#include "host/dispatch.h"

#include <utility>

#include "host/from_proto.h"

namespace spherule::host {

namespace {

using Outcome = std::optional<Result<sim::Applied>>;

Outcome load(const v1::LoadScene& message, SimulationHost& host) {
    auto make = makeSceneOf(message, host.device().info().kind, host.overrides());
    if (!make) return tl::unexpected(make.error());
    return host.load(std::move(*make));
}

// A command that changes the world.
Outcome change(const Request& request, SimulationHost& host) {
    const v1::Command& command = request.command;
    auto converted = worldCommandOf(command, request.session);
    if (!converted) return fail(ErrorKind::Refused, "", "this command is not one for a simulation", Cause::Unfit);
    std::optional<double> speed;
    if (command.has_set() && command.set().has_speed()) {
        speed = command.set().speed();
        if (auto right = checkSpeed(*speed); !right) return tl::unexpected(right.error());
    }
    if (!*converted) return tl::unexpected(converted->error());
    return host.change(**converted, speed);
}

// The result of a command that is carried out at once.
Outcome at(const SimulationHost& host, const Result<void>& done = {}) {
    if (!done) return tl::unexpected(done.error());
    return host.applied();
}

}  // namespace

Outcome dispatch(const Request& request, SimulationHost& host, ProducerCommands& producer) {
    const v1::Command& command = request.command;
    switch (command.kind_case()) {
        case v1::Command::kPause:
            host.pause();
            return at(host);
        case v1::Command::kResume:
            host.resume();
            return at(host);
        case v1::Command::kStep:
            return at(host, host.step(command.step().count()));
        case v1::Command::kLoad:
            return load(command.load(), host);
        case v1::Command::kQuery:
            return host.query();
        case v1::Command::kInspect:
            return host.inspect(command.inspect().sphere());
        case v1::Command::kSeek:
            return fail(ErrorKind::Refused, "", "a simulation has no other time than now: record it, and play that",
                        Cause::Unfit);
        case v1::Command::kStartRecording:
            return at(host, producer.startRecording());
        case v1::Command::kStopRecording:
            return at(host, producer.stopRecording());
        case v1::Command::kCancel:
            return at(host, producer.cancel());
        case v1::Command::kCheckpoint:
            return producer.saveCheckpoint();
        default:
            return change(request, host);
    }
}

}  // namespace spherule::host

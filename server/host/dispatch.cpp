#include "host/dispatch.h"

#include <utility>

#include "host/from_proto.h"

namespace spherule::host {

namespace {

using Outcome = std::optional<Result<sim::Applied>>;

Outcome set(const v1::Set& message, SimulationHost& host) {
    auto set = setOf(message);
    if (message.has_speed())
        if (auto right = checkSpeed(message.speed()); !right) return tl::unexpected(right.error());
    if (!set) return tl::unexpected(set.error());
    return host.change(std::move(*set), message.has_speed() ? std::optional(message.speed()) : std::nullopt);
}

Outcome push(const v1::Push& message, SimulationHost& host) {
    auto push = pushOf(message);
    if (!push) return tl::unexpected(push.error());
    return host.change(*push);
}

Outcome pull(const v1::Pull& message, std::uint64_t session, SimulationHost& host) {
    auto pull = pullOf(message, session);
    if (!pull) return tl::unexpected(pull.error());
    return host.change(*pull);
}

Outcome remove(const v1::Remove& message, SimulationHost& host) {
    auto remove = removeOf(message);
    if (!remove) return tl::unexpected(remove.error());
    return host.change(std::move(*remove));
}

Outcome load(const v1::LoadScene& message, SimulationHost& host) {
    auto make = makeSceneOf(message, host.device().info().kind, host.overrides());
    if (!make) return tl::unexpected(make.error());
    return host.load(std::move(*make));
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
        case v1::Command::kReset:
            return host.change(sim::Reset());
        case v1::Command::kLoad:
            return load(command.load(), host);
        case v1::Command::kSet:
            return set(command.set(), host);
        case v1::Command::kSpawn:
            return host.change(spawnOf(command.spawn()));
        case v1::Command::kRemove:
            return remove(command.remove(), host);
        case v1::Command::kAddObstacle:
            return host.change(changeOf(command.add_obstacle()));
        case v1::Command::kMoveObstacle:
            return host.change(changeOf(command.move_obstacle()));
        case v1::Command::kRemoveObstacle:
            return host.change(changeOf(command.remove_obstacle()));
        case v1::Command::kAddField:
        case v1::Command::kChangeField:
        case v1::Command::kRemoveField:
        case v1::Command::kAddEmitter:
        case v1::Command::kChangeEmitter:
        case v1::Command::kRemoveEmitter:
        case v1::Command::kAddMaterial:
        case v1::Command::kChangeMaterial:
        case v1::Command::kRemoveMaterial:
        case v1::Command::kSetPair:
        case v1::Command::kChangeGroup:
        case v1::Command::kRemoveGroup:
            return host.change(*partCommandOf(command));
        case v1::Command::kPush:
            return push(command.push(), host);
        case v1::Command::kPull:
            return pull(command.pull(), request.session, host);
        case v1::Command::kRelease:
            return host.change(sim::Release{request.session});
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
        case v1::Command::KIND_NOT_SET:
            break;
    }
    return fail(ErrorKind::Refused, "", "this command is not one for a simulation", Cause::Unfit);
}

}  // namespace spherule::host

#include "app/dispatch.h"

#include <utility>

#include "app/from_proto.h"

namespace spherule::app {

namespace {

using Outcome = std::optional<Result<sim::Applied>>;

Outcome set(const v1::Set& message, World& world) {
    auto set = setOf(message);
    if (message.has_speed())
        if (auto right = checkSpeed(message.speed()); !right) return tl::unexpected(right.error());
    if (!set) return tl::unexpected(set.error());
    return world.change(std::move(*set), message.has_speed() ? std::optional(message.speed()) : std::nullopt);
}

Outcome push(const v1::Push& message, World& world) {
    auto push = pushOf(message);
    if (!push) return tl::unexpected(push.error());
    return world.change(*push);
}

Outcome load(const v1::LoadScene& message, World& world) {
    auto make = makeSceneOf(message, world.device().info().kind, world.overrides());
    if (!make) return tl::unexpected(make.error());
    return world.load(std::move(*make));
}

// The result of a command that is carried out at once.
Outcome at(const World& world, const Result<void>& done = {}) {
    if (!done) return tl::unexpected(done.error());
    return world.applied();
}

}  // namespace

Outcome dispatch(const v1::Command& command, World& world, HostCommands& host) {
    switch (command.kind_case()) {
        case v1::Command::kPause:
            world.pause();
            return at(world);
        case v1::Command::kResume:
            world.resume();
            return at(world);
        case v1::Command::kStep:
            return at(world, world.step(command.step().count()));
        case v1::Command::kReset:
            return world.change(sim::Reset());
        case v1::Command::kLoad:
            return load(command.load(), world);
        case v1::Command::kSet:
            return set(command.set(), world);
        case v1::Command::kSpawn:
            return world.change(spawnOf(command.spawn()));
        case v1::Command::kPush:
            return push(command.push(), world);
        case v1::Command::kQuery:
            return world.query();
        case v1::Command::kSeek:
            return fail(ErrorKind::Refused, "", "a simulation has no other time than now: record it, and play that");
        case v1::Command::kStartRecording:
            return at(world, host.startRecording());
        case v1::Command::kStopRecording:
            return at(world, host.stopRecording());
        case v1::Command::kCancel:
            return at(world, host.cancel());
        case v1::Command::KIND_NOT_SET:
            break;
    }
    return fail(ErrorKind::Refused, "", "this command is not one for a simulation");
}

}  // namespace spherule::app

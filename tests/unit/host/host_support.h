#pragma once

#include "app/dispatch.h"

namespace spherule::app {

// A host without recordings, in which nothing can be cancelled.
class NoHost : public HostCommands {
    Result<void> startRecording() override { return none(); }
    Result<void> stopRecording() override { return none(); }
    Result<void> cancel() override { return none(); }

    static Result<void> none() { return fail(ErrorKind::Refused, "", "there is no host"); }
};

// Applies a command to a world without recordings.
inline std::optional<Result<sim::Applied>> give(World& world, const v1::Command& command) {
    NoHost host;
    return dispatch(command, world, host);
}

}  // namespace spherule::app

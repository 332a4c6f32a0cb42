#pragma once

#include "host/dispatch.h"

namespace spherule::host {

// A host without recordings, in which nothing can be cancelled.
class NoHost : public ProducerCommands {
    Result<void> startRecording() override { return none(); }
    Result<void> stopRecording() override { return none(); }
    Result<void> cancel() override { return none(); }

    static Result<void> none() { return fail(ErrorKind::Refused, "", "there is no host"); }
};

// Applies a command to a world without recordings.
inline std::optional<Result<sim::Applied>> give(SimulationHost& world, const v1::Command& command) {
    NoHost host;
    return dispatch(command, world, host);
}

}  // namespace spherule::host

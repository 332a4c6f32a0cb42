#pragma once

#include "host/dispatch.h"

namespace spherule::host {

// A producer without recordings, in which nothing can be cancelled.
class NoProducerCommands : public ProducerCommands {
    Result<void> startRecording() override { return none(); }
    Result<void> stopRecording() override { return none(); }
    Result<void> cancel() override { return none(); }
    std::optional<Result<sim::Applied>> saveCheckpoint() override { return tl::unexpected(none().error()); }

    static Result<void> none() { return fail(ErrorKind::Refused, "", "there is no producer"); }
};

// Applies a command to a simulation without recordings.
inline std::optional<Result<sim::Applied>> give(SimulationHost& host, const v1::Command& command) {
    NoProducerCommands commands;
    return dispatch({.session = 1, .command = command}, host, commands);
}

}  // namespace spherule::host

#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "spherule/v1/control.pb.h"

// Remote control of a server from a shell. Blocks; one thread.
namespace spherule::client {

// Server and credentials.
struct Target {
    std::string url;
    std::string token{};        // empty: none
    std::string authorities{};  // PEM, see Client::connect()
    // For each step. Restarts when the server reports progress of the command.
    std::chrono::milliseconds timeout{30'000};
};

// Connects, sends the command and waits for its result. If another session holds the control lock, calls `onHolder`,
// requests the lock and tries again. Calls `onProgress` with the progress of a long command. A refused command is a
// result, not an error. Errors: see Client, and Refused if no answer comes in time.
Result<v1::CommandResult> sendCommand(const Target& target, v1::Command command,
                                      const std::function<void(const v1::Person& holder)>& onHolder,
                                      const std::function<void(const v1::Change& change)>& onProgress);

// Text for users: "applied at step 120" or "refused: ..."; for a query, its statistics as JSON. Has no control
// characters.
std::string resultText(const v1::CommandResult& result);

}  // namespace spherule::client

#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "spherule/v1/control.pb.h"

// Remote control from a shell: words in, a command out, its result as text.
namespace spherule::net {

// The forms that commandFrom takes, one per line.
std::string commandForms();

// Of `set gravity 0 0 -1.6` and the like, or of one word that is the JSON form of a Command. `load FILE.json` reads the
// file. Anything else is an error that lists what is accepted.
Result<v1::Command> commandFrom(const std::vector<std::string>& words);

// Where to, and as whom.
struct Target {
    std::string url;
    std::string token{};        // empty: none
    std::string authorities{};  // PEM, as Client::connect wants it
    std::chrono::milliseconds timeout{
        30'000};  // of each of the steps; longer while the server says how far it has come
};

// Connects, says hello without asking for states, sends the command and waits for its result. Where somebody else has
// the controls, it asks for them first, and `asks` is called with who that is. `hears` is called with how far a command
// that takes long has come. A refused command is a result, not an error.
Result<v1::CommandResult> sendCommand(const Target& target, v1::Command command,
                                      const std::function<void(const v1::Person& holder)>& asks,
                                      const std::function<void(const v1::Change& change)>& hears);

// For people: "applied at step 120" or "refused: ..."; of a query its figures alone, as JSON. A terminal only shows it.
std::string resultText(const v1::CommandResult& result);

}  // namespace spherule::net

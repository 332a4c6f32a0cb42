#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "spherule/v1/control.pb.h"

// Parses the words of `spherule ctl` into commands. Any thread.
namespace spherule::client {

// The forms that commandFrom takes, one per line.
extern const std::string_view commandForms;

// Of `set gravity 0 0 -1.6` and the like, or of one word that is the JSON form of a Command. `load FILE.json` reads the
// file. Anything else is an error that lists what is accepted.
Result<v1::Command> commandFrom(const std::vector<std::string>& words);

}  // namespace spherule::client

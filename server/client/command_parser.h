#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "spherule/v1/control.pb.h"

// Parses the words of `spherule ctl` into commands. Any thread.
namespace spherule::client {

// The forms that commandFrom() accepts, one per line.
std::string commandForms();

// Parses words such as `set gravity 0 0 -1.6`, or one word with the JSON form of a Command. `load FILE.json` reads the
// file. Input, with the accepted forms, for anything else.
Result<v1::Command> commandFrom(const std::vector<std::string>& words);

}  // namespace spherule::client

#pragma once

#include <string>
#include <vector>

#include "spherule/v1/control.pb.h"

// The rules and the name of each command, as defined in control.proto.
namespace spherule::net {

// The rules of a command; the defaults for a command that is not known.
const v1::CommandRules& rulesOf(const v1::Command& command);

// The command's name in control.proto, such as "start_recording"; empty for a command that is not known.
const std::string& nameOf(const v1::Command& command);

// The fields of Command.kind, in the order of control.proto.
std::vector<const google::protobuf::FieldDescriptor*> commandFields();

}  // namespace spherule::net

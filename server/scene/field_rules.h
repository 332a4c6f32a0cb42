#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <google/protobuf/descriptor.h>

#include "spherule/v1/rules.pb.h"

// The fields of a scene as scene.proto describes them: rules and comments. Any thread.
namespace spherule::scene {

const v1::Rule& ruleOf(const google::protobuf::FieldDescriptor& field);

// Returns true if exactly one member must be given; otherwise at most one.
bool needsOne(const google::protobuf::OneofDescriptor& oneof);

// Returns the comment of the message or field in scene.proto. A field without one has the comment of its message.
std::string meaningOf(const google::protobuf::Descriptor& message);
std::string meaningOf(const google::protobuf::FieldDescriptor& field);

// Returns the names of the values that a scene may give.
std::vector<std::string> namesOf(const google::protobuf::EnumDescriptor& values);
std::vector<std::string> namesOf(const google::protobuf::OneofDescriptor& oneof);
std::vector<std::string> namesOf(const google::protobuf::Descriptor& message);

// The largest number below 2^64 (double).
constexpr double largestWhole = 0x1.fffffffffffffp63;

// Returns true if the value is a whole number, not negative.
bool isWhole(const google::protobuf::FieldDescriptor& field);

// Returns the type of the value, or of an entry of the list, for messages.
std::string wantedText(const google::protobuf::FieldDescriptor& field);

// Returns the reason why the number is out of range; empty if it is not.
std::string whyOutOfRange(const google::protobuf::FieldDescriptor& field, double value);

// Returns the messages of which a scene consists, each before those that it contains.
std::vector<const google::protobuf::Descriptor*> messagesOfScene();

// Returns "; Material has one of this name" if one or two other messages of a scene have a field of this name.
std::string otherOwnersOf(std::string_view field, const google::protobuf::Descriptor& message);

}  // namespace spherule::scene

#include "net/command_rules.h"

#include <google/protobuf/descriptor.h>

namespace spherule::net {

namespace {

struct Entry {
    v1::CommandRules rules;
    std::string name;
};

// Returns the entries, by field number.
std::vector<Entry> readTable() {
    std::vector<Entry> table(1);
    for (const auto* const field : commandFields()) {
        const auto number = static_cast<std::size_t>(field->number());
        if (number >= table.size()) table.resize(number + 1);
        table[number] = {field->options().GetExtension(v1::command_rules), field->name()};
    }
    return table;
}

const Entry& entryOf(const v1::Command& command) {
    static const std::vector<Entry> table = readTable();
    return table[static_cast<std::size_t>(command.kind_case())];
}

}  // namespace

const v1::CommandRules& rulesOf(const v1::Command& command) {
    return entryOf(command).rules;
}

const std::string& nameOf(const v1::Command& command) {
    return entryOf(command).name;
}

std::vector<const google::protobuf::FieldDescriptor*> commandFields() {
    const auto& kinds = *v1::Command::descriptor()->oneof_decl(0);
    std::vector<const google::protobuf::FieldDescriptor*> fields;
    for (int k = 0; k < kinds.field_count(); ++k) fields.push_back(kinds.field(k));
    return fields;
}

}  // namespace spherule::net

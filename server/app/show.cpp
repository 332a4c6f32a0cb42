#include "app/show.h"

#include "core/text.h"

namespace spherule::app {

namespace {

// Of the field that `where` begins with, in the command's own message; empty where that has no such field.
std::string fieldOf(const v1::Command& command, std::string_view where) {
    const auto& kinds = *v1::Command::descriptor()->oneof_decl(0);
    const auto* const kind = command.GetReflection()->GetOneofFieldDescriptor(command, &kinds);
    const std::string_view root = where.substr(0, where.find_first_of(".["));
    for (int k = 0; kind != nullptr && k < kind->message_type()->field_count(); ++k)
        if (kind->message_type()->field(k)->json_name() == root)
            return std::string(kind->json_name()).append(".").append(where);
    return "";
}

}  // namespace

v1::CommandResult resultOf(const v1::Command& command, const Result<v1::Applied>& applied) {
    v1::CommandResult result;
    result.set_id(command.id());
    if (applied) {
        *result.mutable_applied() = *applied;
    } else {
        std::string field = fieldOf(command, applied.error().where);
        result.mutable_refused()->set_reason(utf8(field.empty() ? applied.error().text() : applied.error().message));
        result.mutable_refused()->set_field(std::move(field));
    }
    return result;
}

std::string changeOf(const v1::Command& command) {
    if (command.has_load()) {
        const v1::LoadScene& load = command.load();
        return "load " + utf8(load.has_scene() ? load.scene().name() : load.name());
    }
    if (command.has_step()) return "step";
    return command.has_reset() ? "reset" : command.has_spawn() ? "spawn" : "set";
}

}  // namespace spherule::app

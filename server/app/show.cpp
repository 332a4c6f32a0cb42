#include "app/show.h"

#include "app/utf8.h"

namespace spherule::app {

v1::CommandResult resultOf(const v1::Command& command, const Result<v1::Applied>& applied) {
    v1::CommandResult result;
    result.set_id(command.id());
    if (applied) {
        *result.mutable_applied() = *applied;
    } else {
        result.mutable_refused()->set_field(applied.error().where);
        result.mutable_refused()->set_reason(utf8(applied.error().message));
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

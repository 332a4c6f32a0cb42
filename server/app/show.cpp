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

}  // namespace spherule::app

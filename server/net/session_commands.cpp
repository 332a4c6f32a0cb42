// Checks and forwards the commands of a session.
#include <utility>

#include "net/command_rules.h"
#include "net/session.h"

namespace spherule::net {

namespace {

constexpr const char* tooMany = "too many commands came from this client within a second";

v1::Refused::Cause refusedCause(RejectReason reason) {
    switch (reason) {
        case RejectReason::CommandRate:
        case RejectReason::CommandQueue:
            return v1::Refused::TOO_MANY_COMMANDS;
        case RejectReason::ViewersCommand:
            return v1::Refused::NOT_ALLOWED;
        case RejectReason::ControlHeld:
            return v1::Refused::CONTROL_HELD;
        default:
            return v1::Refused::UNFIT;
    }
}

}  // namespace

// Refuses a message before it is parsed: when it needs too much memory, or is long and its command could not be queued.
bool Session::refusedUnparsed(const Preview& preview, std::size_t bytes) {
    const Options& options = state_.options;
    if (preview.cost > options.maxMessageCost) {
        refuse(preview.id, RejectReason::CommandCost,
               "the message takes more than " + std::to_string(options.maxMessageCost >> 20U) +
                   " MiB of memory when it is read: send it in parts");
        return true;
    }
    if (bytes <= options.firstMessageBytes) return false;
    if (!commands_.has(TokenBucket::Clock::now())) {
        refuse(preview.id, RejectReason::CommandRate, tooMany);
        return true;
    }
    const auto reason = state_.handlers.refuses(id_, preview.cost);
    if (reason) refuse(preview.id, RejectReason::CommandQueue, *reason);
    return reason.has_value();
}

void Session::onInvalidCommand(const Preview& preview, const Error& error) {
    if (preview.command) ++state_.counters.commands;
    if (!commands_.take(TokenBucket::Clock::now())) return refuse(preview.id, RejectReason::CommandRate, tooMany);
    refuse(preview.id, RejectReason::UnfitCommand, error.message, error.where);
}

void Session::onCommand(v1::Command command, std::size_t cost) {
    const std::uint64_t id = command.id();
    ++state_.counters.commands;
    if (!commands_.take(TokenBucket::Clock::now())) return refuse(id, RejectReason::CommandRate, tooMany);
    if (command.kind_case() == v1::Command::KIND_NOT_SET)
        return refuse(id, RejectReason::UnknownCommand, "the command is not known to this server");
    if (!rulesOf(command).viewer_may()) {
        if (role_ != v1::CONTROLLER)
            return refuse(id, RejectReason::ViewersCommand,
                          "a viewer may not command: that takes the controllers' token");
        if (state_.exclusiveControl && !state_.controlLock.acquire(id_, client_))
            return refuse(id, RejectReason::ControlHeld,
                          state_.controlLock.state().holder().client() + " (session " +
                              std::to_string(state_.controlLock.state().holder().session()) +
                              ") has control: ask for it");
    }
    if (const auto reason = state_.handlers.submit(id_, std::move(command), cost))
        refuse(id, RejectReason::CommandQueue, *reason);
}

void Session::refuse(std::uint64_t command, RejectReason cause, const std::string& reason, const std::string& field) {
    state_.rejectionLog.rejected(cause, description());
    v1::ServerMessage message;
    message.mutable_result()->set_id(command);
    message.mutable_result()->mutable_refused()->set_field(field);
    message.mutable_result()->mutable_refused()->set_reason(reason);
    message.mutable_result()->mutable_refused()->set_cause(refusedCause(cause));
    queue(std::make_shared<codec::Message>(std::move(message)));
}

// Without exclusive control every controller may send commands, so requests have no effect.
void Session::onControlRequest(const v1::ClientMessage& message) {
    if (!state_.exclusiveControl) return;
    if (role_ != v1::CONTROLLER || !commands_.take(TokenBucket::Clock::now())) {
        state_.rejectionLog.rejected(role_ != v1::CONTROLLER ? RejectReason::ViewersCommand : RejectReason::CommandRate,
                                     description());
        return;
    }
    if (message.has_ask_control()) state_.controlLock.request(id_, client_);
    if (message.has_yield_control()) state_.controlLock.release(id_, message.yield_control().session());
    if (message.has_keep_control()) state_.controlLock.denyRequests(id_);
}

std::string Session::description() const {
    return peer_ + " (" + client_ + ")";
}

}  // namespace spherule::net

// The commands of a session.
#include <utility>

#include "net/command_rules.h"
#include "net/session.h"

namespace spherule::net {

namespace {

constexpr const char* tooMany = "too many commands came from this client within a second";

}  // namespace

// Parsing takes time and memory. A long message is parsed only if its command may then wait.
bool Session::refusesUnparsed(const Preview& preview, std::size_t bytes) {
    const Options& options = context_.options;
    if (preview.cost > options.maxMessageCost) {
        refuse(preview.id, Rejection::CommandCost,
               "the message takes more than " + std::to_string(options.maxMessageCost >> 20U) +
                   " MiB of memory when it is read: send it in parts");
        return true;
    }
    if (bytes <= options.firstMessageBytes) return false;
    if (!commands_.has(TokenBucket::Clock::now())) {
        refuse(preview.id, Rejection::CommandRate, tooMany);
        return true;
    }
    const auto reason = context_.handlers.refuses(id_, preview.cost);
    if (reason) refuse(preview.id, Rejection::CommandQueue, *reason);
    return reason.has_value();
}

void Session::onUnfit(const Preview& preview, const Error& error) {
    if (preview.command) ++context_.counters.commands;
    if (!commands_.take(TokenBucket::Clock::now())) return refuse(preview.id, Rejection::CommandRate, tooMany);
    refuse(preview.id, Rejection::UnfitCommand, error.message, error.where);
}

void Session::onCommand(v1::Command command, std::size_t cost) {
    const std::uint64_t id = command.id();
    ++context_.counters.commands;
    if (!commands_.take(TokenBucket::Clock::now())) return refuse(id, Rejection::CommandRate, tooMany);
    if (command.kind_case() == v1::Command::KIND_NOT_SET)
        return refuse(id, Rejection::UnknownCommand, "the command is not known to this server");
    if (!rulesOf(command).viewer_may()) {
        if (role_ != v1::CONTROLLER)
            return refuse(id, Rejection::ViewersCommand, "a viewer may not command: that takes the controllers' token");
        if (context_.leased && !context_.lease.take(id_, client_))
            return refuse(id, Rejection::ControlsHeld,
                          context_.lease.state().holder().client() + " (session " +
                              std::to_string(context_.lease.state().holder().session()) +
                              ") has the controls: ask for them");
    }
    if (const auto reason = context_.handlers.submit(id_, std::move(command), cost))
        refuse(id, Rejection::CommandQueue, *reason);
}

void Session::refuse(std::uint64_t command, Rejection cause, const std::string& reason, const std::string& field) {
    context_.refusals.add(cause, who());
    v1::ServerMessage message;
    message.mutable_result()->set_id(command);
    message.mutable_result()->mutable_refused()->set_field(field);
    message.mutable_result()->mutable_refused()->set_reason(reason);
    queue(std::make_shared<frame::Message>(std::move(message)));
}

// A server that takes commands from every controller has no control to ask for.
void Session::onControls(const v1::ClientMessage& message) {
    if (!context_.leased) return;
    if (role_ != v1::CONTROLLER || !commands_.take(TokenBucket::Clock::now())) {
        context_.refusals.add(role_ != v1::CONTROLLER ? Rejection::ViewersCommand : Rejection::CommandRate, who());
        return;
    }
    if (message.has_ask_control()) context_.lease.ask(id_, client_);
    if (message.has_yield_control()) context_.lease.yield(id_, message.yield_control().session());
    if (message.has_keep_control()) context_.lease.keep(id_);
}

std::string Session::who() const {
    return peer_ + " (" + client_ + ")";
}

}  // namespace spherule::net

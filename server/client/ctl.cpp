#include "client/ctl.h"

#include <utility>

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include "client/client.h"
#include "core/text.h"

namespace spherule::client {

namespace {

// JSON with one field per line; statistics are named as in `spherule run --json`.
std::string figures(const google::protobuf::Message& message) {
    google::protobuf::util::JsonPrintOptions options;
    options.add_whitespace = true;
    options.always_print_primitive_fields = true;
    std::string text;
    const auto status = google::protobuf::util::MessageToJsonString(message, &text, options);
    return status.ok() ? text : status.ToString();
}

// The reports of the server about the role and the control lock.
struct ControlStatus {
    std::uint64_t session = 0;
    v1::Role role = v1::ROLE_UNSPECIFIED;
    std::optional<v1::Control> control;  // set if the server has a control lock

    void update(const v1::ServerMessage& message) {
        if (message.has_welcome()) {
            session = message.welcome().session();
            role = message.welcome().role();
        }
        if (message.has_control()) control = message.control();
    }
    [[nodiscard]] bool needsLock() const {
        return role == v1::CONTROLLER && control && control->has_holder() && control->holder().session() != session;
    }
};

// One connection to a server, with a timeout for each wait.
class Conversation {
  public:
    Conversation(std::unique_ptr<Client> client, const Target& target,
                 const std::function<void(const v1::Change&)>& onProgress)
        : client_(std::move(client)), target_(target), onProgress_(onProgress) {}

    Result<void> send(const v1::ClientMessage& message) { return client_->send(message); }

    Result<v1::CommandResult> execute(const v1::Command& command) {
        v1::ClientMessage message;
        *message.mutable_command() = command;
        if (auto sent = send(message); !sent) return tl::unexpected(sent.error());
        v1::CommandResult result;
        auto received = receiveUntil(
            [&](const v1::ServerMessage& answer) {
                if (!answer.has_result() || answer.result().id() != command.id()) return false;
                result = answer.result();
                return true;
            },
            "gave no answer in time; the command may still apply", true);
        if (!received) return tl::unexpected(received.error());
        return result;
    }

    Result<void> requestLock() {
        v1::ClientMessage request;
        request.mutable_ask_control();
        if (auto sent = send(request); !sent) return sent;
        return receiveUntil([&](const auto&) { return !status.needsLock(); }, "control was not handed over in time",
                            false);
    }

    void end() { client_->close(); }

    ControlStatus status;

  private:
    // Receives until `done` returns true. Refused with the text `late` after the timeout. `patient`: progress reports
    // restart the timeout.
    Result<void> receiveUntil(const std::function<bool(const v1::ServerMessage&)>& done, const char* late,
                              bool patient) {
        auto end = std::chrono::steady_clock::now() + target_.timeout;
        for (;;) {
            const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
            if (left.count() <= 0) return fail(ErrorKind::Refused, target_.url, late);
            auto received = client_->receive(left);
            if (!received) return tl::unexpected(received.error());
            if (!*received) continue;
            status.update(**received);
            if (done(**received)) return {};
            if (!patient || !(*received)->has_change() || (*received)->change().what().empty()) continue;
            onProgress_((*received)->change());
            end = std::chrono::steady_clock::now() + target_.timeout;
        }
    }

    std::unique_ptr<Client> client_;
    const Target& target_;
    const std::function<void(const v1::Change&)>& onProgress_;
};

}  // namespace

Result<v1::CommandResult> sendCommand(const Target& target, v1::Command command,
                                      const std::function<void(const v1::Person& holder)>& onHolder,
                                      const std::function<void(const v1::Change& change)>& onProgress) {
    auto client = Client::connect(target.url, target.timeout, "spherule.v1", target.authorities);
    if (!client) return tl::unexpected(client.error());
    Conversation conversation(std::move(*client), target, onProgress);
    if (command.id() == 0) command.set_id(1);

    v1::ClientMessage hello;
    hello.mutable_hello()->set_client("spherule ctl");
    hello.mutable_hello()->set_token(target.token);
    hello.mutable_hello()->mutable_view()->set_rate(0);
    if (auto sent = conversation.send(hello); !sent) return tl::unexpected(sent.error());

    auto result = conversation.execute(command);
    // The server reports the holder of the lock before it answers the command.
    if (result && result->has_refused() && conversation.status.needsLock()) {
        onHolder(conversation.status.control->holder());
        if (auto granted = conversation.requestLock(); !granted) return tl::unexpected(granted.error());
        result = conversation.execute(command);
    }
    if (result) conversation.end();
    return result;
}

std::string resultText(const v1::CommandResult& result) {
    if (result.has_refused()) {
        const v1::Refused& refused = result.refused();
        const std::string_view separator = refused.field().empty() ? "" : ": ";
        return withoutControls(fmt::format("refused: {}{}{}", refused.field(), separator, refused.reason()));
    }
    const v1::Applied& applied = result.applied();
    if (applied.has_statistics()) return figures(applied.statistics());
    if (applied.has_inspected()) return figures(applied.inspected());
    std::string text = fmt::format("applied at step {}", applied.step());
    if (applied.has_number()) text += fmt::format(", number {}", applied.number());
    if (!applied.file().empty()) text += fmt::format(", checkpoint {}", withoutControls(applied.file()));
    if (applied.has_sphere()) text += fmt::format(", hit sphere {}", applied.sphere());
    return text;
}

}  // namespace spherule::client

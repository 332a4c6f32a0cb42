#include "client/ctl.h"

#include <utility>

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include "client/client.h"
#include "core/text.h"

namespace spherule::client {

namespace {

// The figures one per line, named as in `spherule run --json`.
std::string figures(const v1::Statistics& statistics) {
    google::protobuf::util::JsonPrintOptions options;
    options.add_whitespace = true;
    options.always_print_primitive_fields = true;
    std::string text;
    const auto status = google::protobuf::util::MessageToJsonString(statistics, &text, options);
    return status.ok() ? text : status.ToString();
}

// What a server has to say before, as far as that decides whether a command is one's to give.
struct Standing {
    std::uint64_t session = 0;
    v1::Role role = v1::ROLE_UNSPECIFIED;
    std::optional<v1::Control> control;  // of a server that gives the controls to one at a time

    void hear(const v1::ServerMessage& message) {
        if (message.has_welcome()) {
            session = message.welcome().session();
            role = message.welcome().role();
        }
        if (message.has_control()) control = message.control();
    }
    [[nodiscard]] bool mustAsk() const {
        return role == v1::CONTROLLER && control && control->has_holder() && control->holder().session() != session;
    }
};

// One connection to a server, with a limit on each wait.
class Conversation {
  public:
    Conversation(std::unique_ptr<Client> client, const Target& target,
                 const std::function<void(const v1::Change&)>& hears)
        : client_(std::move(client)), target_(target), hears_(hears) {}

    Result<void> say(const v1::ClientMessage& message) { return client_->send(message); }

    Result<v1::CommandResult> give(const v1::Command& command) {
        v1::ClientMessage message;
        *message.mutable_command() = command;
        if (auto sent = say(message); !sent) return tl::unexpected(sent.error());
        v1::CommandResult result;
        auto heard = hearUntil(
            [&](const v1::ServerMessage& answer) {
                if (!answer.has_result() || answer.result().id() != command.id()) return false;
                result = answer.result();
                return true;
            },
            "gave no answer in time; the command may still apply", true);
        if (!heard) return tl::unexpected(heard.error());
        return result;
    }

    Result<void> askForControls() {
        v1::ClientMessage ask;
        ask.mutable_ask_control();
        if (auto sent = say(ask); !sent) return sent;
        return hearUntil([&](const auto&) { return !standing.mustAsk(); }, "the controls were not handed over in time",
                         false);
    }

    void end() { client_->close(); }

    Standing standing;

  private:
    // Hears until `enough`, or fails with `late`; `patient`: not as long as some command progresses.
    Result<void> hearUntil(const std::function<bool(const v1::ServerMessage&)>& enough, const char* late,
                           bool patient) {
        auto end = std::chrono::steady_clock::now() + target_.timeout;
        for (;;) {
            const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
            if (left.count() <= 0) return fail(ErrorKind::Refused, target_.url, late);
            auto received = client_->receive(left);
            if (!received) return tl::unexpected(received.error());
            if (!*received) continue;
            standing.hear(**received);
            if (enough(**received)) return {};
            if (!patient || !(*received)->has_change() || (*received)->change().what().empty()) continue;
            hears_((*received)->change());
            end = std::chrono::steady_clock::now() + target_.timeout;
        }
    }

    std::unique_ptr<Client> client_;
    const Target& target_;
    const std::function<void(const v1::Change&)>& hears_;
};

}  // namespace

Result<v1::CommandResult> sendCommand(const Target& target, v1::Command command,
                                      const std::function<void(const v1::Person& holder)>& asks,
                                      const std::function<void(const v1::Change& change)>& hears) {
    auto client = Client::connect(target.url, target.timeout, "spherule.v1", target.authorities);
    if (!client) return tl::unexpected(client.error());
    Conversation conversation(std::move(*client), target, hears);
    if (command.id() == 0) command.set_id(1);

    v1::ClientMessage hello;
    hello.mutable_hello()->set_client("spherule ctl");
    hello.mutable_hello()->set_token(target.token);
    hello.mutable_hello()->mutable_view()->set_rate(0);
    if (auto sent = conversation.say(hello); !sent) return tl::unexpected(sent.error());

    auto result = conversation.give(command);
    // Only now it is known who has the controls: that comes before the answer.
    if (result && result->has_refused() && conversation.standing.mustAsk()) {
        asks(conversation.standing.control->holder());
        if (auto handed = conversation.askForControls(); !handed) return tl::unexpected(handed.error());
        result = conversation.give(command);
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
    std::string text = fmt::format("applied at step {}", applied.step());
    if (applied.has_sphere()) text += fmt::format(", hit sphere {}", applied.sphere());
    return text;
}

}  // namespace spherule::client

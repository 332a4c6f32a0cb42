#include "net/ctl.h"

#include <utility>

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include "net/client.h"

namespace spherule::net {

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

}  // namespace

Result<v1::CommandResult> sendCommand(const std::string& url, v1::Command command, std::chrono::milliseconds timeout) {
    auto client = Client::connect(url, timeout);
    if (!client) return tl::unexpected(client.error());

    v1::ClientMessage hello;
    hello.mutable_hello()->set_client("spherule ctl");
    hello.mutable_hello()->mutable_view()->set_rate(0);
    if (auto sent = (*client)->send(hello); !sent) return tl::unexpected(sent.error());

    if (command.id() == 0) command.set_id(1);
    const std::uint64_t id = command.id();
    v1::ClientMessage message;
    *message.mutable_command() = std::move(command);
    if (auto sent = (*client)->send(message); !sent) return tl::unexpected(sent.error());

    const auto end = std::chrono::steady_clock::now() + timeout;
    for (;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        if (left.count() <= 0)
            return fail(ErrorKind::Refused, url, "gave no answer in time; the command may still apply");
        auto received = (*client)->receive(left);
        if (!received) return tl::unexpected(received.error());
        if (*received && (*received)->has_result() && (*received)->result().id() == id) {
            (*client)->close();
            return std::move(*(*received)->mutable_result());
        }
    }
}

std::string resultText(const v1::CommandResult& result) {
    if (result.has_refused()) {
        const v1::Refused& refused = result.refused();
        const std::string_view separator = refused.field().empty() ? "" : ": ";
        return fmt::format("refused: {}{}{}", refused.field(), separator, refused.reason());
    }
    const v1::Applied& applied = result.applied();
    std::string text = fmt::format("applied at step {}", applied.step());
    if (applied.has_sphere()) text += fmt::format(", hit sphere {}", applied.sphere());
    if (applied.has_statistics()) text += fmt::format("\n{}", figures(applied.statistics()));
    return text;
}

}  // namespace spherule::net

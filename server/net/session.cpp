#include "net/session.h"

#include <algorithm>
#include <utility>

#include "core/log.h"
#include "net/text.h"

namespace spherule::net {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using websocket::close_code;

namespace {

constexpr std::uint32_t defaultRate = 30;
constexpr std::size_t keptBuffer = std::size_t{64} * 1024;  // a larger one is given back after the message

}  // namespace

Session::Session(beast::tcp_stream stream, Context& context)
    : context_(context),
      stream_(std::move(stream)),
      watchTimer_(stream_.get_executor()),
      liveness_({.hello = context.options.helloTimeout,
                 .progress = context.options.progressTimeout,
                 .idle = context.options.idleTimeout},
                Liveness::Clock::now()),
      outbox_(context.options.controlQueue),
      pace_(Pace::Clock::now()) {}

void Session::run(const Request& upgrade) {
    id_ = context_.hub.add(shared_from_this());
    ++context_.counters.sessions;
    configure();
    watch();
    stream_.async_accept(upgrade, bind(&Session::onAccepted));
}

void Session::configure() {
    beast::get_lowest_layer(stream_).expires_never();
    // Liveness keeps the time of an open session; Beast's own limit is left for the handshakes.
    stream_.set_option(websocket::stream_base::timeout{
        .handshake_timeout = context_.options.helloTimeout,
        .idle_timeout = websocket::stream_base::none(),
        .keep_alive_pings = false,
    });
    stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& answer) {
        answer.set(http::field::server, "spherule/" SPHERULE_VERSION);
        answer.set(http::field::sec_websocket_protocol, beast::string_view(subprotocol.data(), subprotocol.size()));
    }));
    stream_.read_message_max(context_.options.maxMessageBytes);
    stream_.auto_fragment(false);
}

void Session::onAccepted(ErrorCode error) {
    if (error) {
        ++context_.counters.handshakesRefused;
        return finish(CloseCause::Protocol);
    }
    if (finished_) return;
    ++context_.counters.accepted;
    pump();  // a drain may have come meanwhile
    read();
}

void Session::read() {
    stream_.async_read(incoming_, bind(&Session::onRead));
}

void Session::onRead(ErrorCode error, std::size_t /*bytes*/) {
    if (error) return finish(causeOf(error));
    if (!closing_) {
        const Encoding encoding = stream_.got_text() ? Encoding::Text : Encoding::Binary;
        const auto bytes = incoming_.cdata();
        auto message = decodeClientMessage({static_cast<const char*>(bytes.data()), bytes.size()}, encoding);
        if (!message) {
            close(close_code::bad_payload, message.error().text(), CloseCause::Undecodable);
        } else if (message->has_hello() == helloDone_) {
            close(close_code::policy_error, helloDone_ ? "hello was said before" : "the first message must be hello",
                  CloseCause::NoHello);
        } else if (!helloDone_) {
            encoding_ = encoding;
            onHello(message->hello());
        } else if (message->has_view()) {
            onView(message->view());
        } else if (message->has_ack()) {
            onAck(message->ack());
        } else {
            onCommand(std::move(*message->mutable_command()));
        }
    }
    incoming_.clear();
    if (incoming_.capacity() > keptBuffer) incoming_.shrink_to_fit();
    read();
}

void Session::onHello(const v1::Hello& hello) {
    helloDone_ = true;
    client_ = printable(hello.client());
    liveness_.helloCame();
    spdlog::debug("session {}: hello from {}", id_, client_);
    v1::ServerMessage message;
    *message.mutable_welcome() = context_.handlers.welcome(hello);
    queue(frame::share(std::move(message)));
    context_.hub.join(id_);
    onView(hello.view());
}

void Session::onView(const v1::View& view) {
    const bool known = v1::Tier_IsValid(view.tier()) && view.tier() != v1::TIER_UNSPECIFIED;
    const frame::Channel wish{known ? view.tier() : v1::NORMAL,
                              frame::rateFor(view.has_rate() ? view.rate() : defaultRate)};
    // Whoever says the same again begins nothing anew.
    if (pace_.want(wish, view.fixed(), Pace::Clock::now()))
        follow("");
    else
        sayStream("");
}

void Session::onAck(const v1::Ack& ack) {
    credit_.acked(ack.sequence());
    if (ack.lost() && outbox_.lose(ack.sequence())) missed();
    const auto now = Pace::Clock::now();
    const auto reason = pace_.acked(static_cast<double>(ack.draw_rate()), static_cast<double>(ack.decode_ms()), now);
    if (reason) follow(*reason);
    askKeyframe();
    pump();
}

void Session::onCommand(v1::Command command) {
    const std::uint64_t id = command.id();
    ++context_.counters.commands;
    if (command.kind_case() == v1::Command::KIND_NOT_SET) return refuse(id, "the command is not known to this server");
    if (!context_.handlers.submit(id_, std::move(command))) refuse(id, "the command queue is full");
}

void Session::refuse(std::uint64_t command, const std::string& reason) {
    ++context_.counters.commandsRefused;
    v1::ServerMessage message;
    message.mutable_result()->set_id(command);
    message.mutable_result()->mutable_refused()->set_reason(reason);
    queue(std::make_shared<frame::Message>(std::move(message)));
}

void Session::finish(CloseCause cause) {
    if (finished_) return;
    finished_ = true;
    watchTimer_.cancel();
    outbox_.clear();
    beast::get_lowest_layer(stream_).close();
    --context_.counters.sessions;
    ++context_.counters.closedBy(cause);
    const auto level =
        cause == CloseCause::Left || cause == CloseCause::Drained ? spdlog::level::debug : spdlog::level::info;
    spdlog::log(level, "session {} ({}) ended: {}", id_, client_, closeCauseNames[static_cast<std::size_t>(cause)]);
    context_.hub.remove(id_);
}

CloseCause Session::causeOf(ErrorCode error) const {
    if (closing_) return cause_;
    if (error == websocket::error::message_too_big) return CloseCause::TooBig;
    if (error == websocket::error::bad_frame_payload) return CloseCause::Undecodable;
    if (error == websocket::condition::protocol_violation) return CloseCause::Protocol;
    return CloseCause::Left;
}

}  // namespace spherule::net

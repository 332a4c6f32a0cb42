#include "net/session.h"

#include <algorithm>
#include <utility>

#include <boost/asio/bind_cancellation_slot.hpp>

#include "core/log.h"
#include "net/sanitize.h"

namespace spherule::net {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using websocket::close_code;

namespace {

constexpr std::uint32_t defaultRate = 30;
constexpr auto tokenWanted = static_cast<close_code>(4401);
constexpr double viewsPerSecond = 10;
constexpr std::size_t keptBuffer = std::size_t{64} * 1024;  // bytes; a larger read buffer is freed after the message

}  // namespace

Session::Session(Transport stream, std::unique_ptr<ConnectionLimiter::Permit> permit, const std::string& peer,
                 ServerState& state)
    : state_(state),
      stream_(std::move(stream)),
      permit_(std::move(permit)),
      peer_(peer),
      timer_(stream_.get_executor()),
      timeouts_({.hello = state.options.helloTimeout,
                 .progress = state.options.progressTimeout,
                 .idle = state.options.idleTimeout},
                SessionTimeouts::Clock::now()),
      sendQueue_(state.options.controlQueue),
      rateController_(RateController::Clock::now()),
      commands_(state.options.commandsPerSecond, TokenBucket::Clock::now()),
      views_(viewsPerSecond, TokenBucket::Clock::now()) {}

void Session::run(const Request& upgrade) {
    protect([&upgrade](Session& self) { self.begin(upgrade); })();
}

void Session::begin(const Request& upgrade) {
    ++state_.counters.sessions;
    id_ = state_.hub.add(shared_from_this());
    configure();
    startTimer();
    stream_.async_accept(upgrade, bind(&Session::onAccepted));
}

void Session::configure() {
    beast::get_lowest_layer(stream_).expires_never();
    // SessionTimeouts covers an open session; Beast's timeout covers only the handshakes.
    stream_.set_option(websocket::stream_base::timeout{
        .handshake_timeout = state_.options.helloTimeout,
        .idle_timeout = websocket::stream_base::none(),
        .keep_alive_pings = false,
    });
    stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& answer) {
        answer.set(http::field::server, "spherule/" SPHERULE_VERSION);
        answer.set(http::field::sec_websocket_protocol, beast::string_view(subprotocol.data(), subprotocol.size()));
    }));
    stream_.read_message_max(state_.options.firstMessageBytes);
    stream_.auto_fragment(false);
}

void Session::onAccepted(ErrorCode error) {
    if (error) {
        state_.rejectionLog.rejected(RejectReason::Handshake, peer_);
        return finish(CloseCause::Protocol);
    }
    if (finished_) return;
    ++state_.counters.accepted;
    pump();  // drain() may have been called meanwhile
    read();
}

void Session::read() {
    stream_.async_read(incoming_, boost::asio::bind_cancellation_slot(cancelRead_.slot(), bind(&Session::onRead)));
}

void Session::onRead(ErrorCode error, std::size_t /*bytes*/) {
    if (finished_) return;  // data received before the end may be read after it
    if (error) return finish(causeOf(error));
    if (!closing_) {
        const auto bytes = incoming_.cdata();
        onBytes({static_cast<const char*>(bytes.data()), bytes.size()},
                stream_.got_text() ? Encoding::Text : Encoding::Binary);
    }
    incoming_.clear();
    if (incoming_.capacity() > keptBuffer) incoming_.shrink_to_fit();
    if (!tokenRejected_ && !closing_) read();  // async_close() reads the peer's close frame
}

void Session::onBytes(std::string_view bytes, Encoding encoding) {
    const Preview preview = previewOf(bytes, encoding, state_.options.maxMessageCost);
    if (helloDone_ && refusedUnparsed(preview, bytes.size())) return;
    auto message = decodeClientMessage(bytes, encoding);
    if (!message) {
        if (helloDone_ && message.error().kind == ErrorKind::Refused) return onInvalidCommand(preview, message.error());
        close(close_code::bad_payload, message.error().text(), CloseCause::Undecodable);
    } else if (message->has_hello() == helloDone_) {
        close(close_code::policy_error, helloDone_ ? "hello was sent before" : "the first message must be hello",
              CloseCause::NoHello);
    } else {
        if (!helloDone_) encoding_ = encoding;
        onMessage(std::move(*message), preview.cost);
    }
}

void Session::onMessage(v1::ClientMessage message, std::size_t cost) {
    switch (message.kind_case()) {
        case v1::ClientMessage::kHello:
            return onHello(message.hello());
        case v1::ClientMessage::kView:
            return onView(message.view());
        case v1::ClientMessage::kAck:
            return onAck(message.ack());
        case v1::ClientMessage::kAskControl:
        case v1::ClientMessage::kYieldControl:
        case v1::ClientMessage::kKeepControl:
            return onControlRequest(message);
        case v1::ClientMessage::kCommand:
        case v1::ClientMessage::KIND_NOT_SET:  // of a newer protocol: a command gets an answer
            return onCommand(std::move(*message.mutable_command()), cost);
    }
}

void Session::onHello(const v1::Hello& hello) {
    helloDone_ = true;
    client_ = sanitize(hello.client());
    turns_ = hello.turns();
    population_ = hello.population();
    timeouts_.helloReceived();
    const auto role = state_.admission->roleOf(hello.token());
    if (!role) return rejectToken(!hello.token().empty());
    if (const auto cause = permit_->openSession()) {
        state_.rejectionLog.rejected(*cause, description());
        return close(close_code::try_again_later,
                     *cause == RejectReason::Sessions ? "the limit of open sessions is reached"
                                                      : "the limit of open sessions of this address is reached",
                     CloseCause::Full);
    }
    admit(hello, *role);
}

void Session::admit(const v1::Hello& hello, v1::Role role) {
    role_ = role;
    if (role == v1::CONTROLLER) stream_.read_message_max(state_.options.maxMessageBytes);
    spdlog::debug("session {}: hello from {}", id_, description());
    v1::ServerMessage message;
    *message.mutable_welcome() = state_.handlers.welcome(hello);
    message.mutable_welcome()->set_role(role);
    message.mutable_welcome()->set_session(id_);
    queue(codec::share(std::move(message)));
    state_.hub.join(id_, client_, population_);
    onView(hello.view());
}

// Delays the close after a wrong token, to slow down guessing. Nothing is read meanwhile.
void Session::rejectToken(bool guessed) {
    state_.rejectionLog.rejected(guessed ? RejectReason::WrongToken : RejectReason::NoToken, peer_);
    if (!guessed) return close(tokenWanted, "this server asks for a token", CloseCause::NoToken);
    tokenRejected_ = true;
    timer_.expires_after(state_.options.guessDelay);
    timer_.async_wait(protect([](Session& self, ErrorCode error) {
        if (error || self.finished_) return;
        self.tokenRejected_ = false;
        self.close(tokenWanted, "this token is not known here", CloseCause::NoToken);
        self.startTimer();
    }));
}

// Each change starts a new chain. Views above the rate limit wait, and only the newest is applied.
void Session::onView(const v1::View& view) {
    if (!views_.take(TokenBucket::Clock::now())) {
        pendingView_ = view;
        return;
    }
    const bool known = v1::Tier_IsValid(view.tier()) && view.tier() != v1::TIER_UNSPECIFIED;
    const codec::Rendition requested{known ? view.tier() : v1::NORMAL,
                                     codec::rateFor(view.has_rate() ? view.rate() : defaultRate),
                                     turns_,
                                     population_,
                                     v1::Quantity_IsValid(view.quantity()) ? view.quantity() : v1::QUANTITY_UNSPECIFIED,
                                     view.spins()};
    // An unchanged view does not restart the chain.
    if (rateController_.setTarget(requested, view.fixed(), RateController::Clock::now()))
        switchRendition("");
    else
        reportStream("");
}

void Session::onAck(const v1::Ack& ack) {
    ackWindow_.acked(ack.sequence());
    if (ack.lost() && sendQueue_.reportLoss(ack.sequence())) onFrameLost();
    const auto now = RateController::Clock::now();
    const auto reason =
        rateController_.onAck(static_cast<double>(ack.draw_rate()), static_cast<double>(ack.decode_ms()), now);
    if (reason) switchRendition(*reason);
    requestKeyframe();
    pump();
}

void Session::finish(CloseCause cause) {
    if (finished_) return;
    finished_ = true;
    timer_.cancel();
    sendQueue_.clear();
    beast::get_lowest_layer(stream_).close();
    --state_.counters.sessions;
    permit_.reset();
    state_.hub.remove(id_);
    state_.controlLock.onSessionEnded(id_);
    state_.handlers.mayNotCommand(id_);
    state_.rejectionLog.ended(cause, description());
}

CloseCause Session::causeOf(ErrorCode error) const {
    if (closing_) return cause_;
    if (error == websocket::error::message_too_big) return CloseCause::TooBig;
    if (error == websocket::error::bad_frame_payload) return CloseCause::Undecodable;
    if (error == websocket::condition::protocol_violation) return CloseCause::Protocol;
    return CloseCause::Left;
}

}  // namespace spherule::net

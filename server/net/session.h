#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <boost/asio/cancellation_signal.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "core/latest_slot.h"
#include "net/ack_window.h"
#include "net/decode.h"
#include "net/hub.h"
#include "net/preview.h"
#include "net/rate_controller.h"
#include "net/send_queue.h"
#include "net/server_state.h"
#include "net/session_timeouts.h"
#include "net/token_bucket.h"
#include "net/transport.h"

namespace spherule::net {

constexpr std::string_view subprotocol = "spherule.v1";

// One WebSocket client. Runs on the strand of its stream; the calls of Subscriber may come from any thread.
class Session : public Subscriber, public std::enable_shared_from_this<Session> {
  public:
    using Request = boost::beast::http::request<boost::beast::http::string_body>;

    Session(Transport stream, std::unique_ptr<ConnectionLimiter::Permit> permit, const std::string& peer,
            ServerState& state);

    // Answers an upgrade request and serves the client until one side closes. Call once, on the strand.
    void run(const Request& upgrade);

    void send(codec::SharedMessage message) override;
    void offer(codec::EncodedFrame encoded) override;
    void drain() override;
    void drop() override;

  private:
    using ErrorCode = boost::beast::error_code;

    void begin(const Request& upgrade);
    void configure();
    void onAccepted(ErrorCode error);
    void read();
    void onRead(ErrorCode error, std::size_t bytes);
    void onBytes(std::string_view bytes, Encoding encoding);
    [[nodiscard]] bool refusedUnparsed(const Preview& preview, std::size_t bytes);
    void onMessage(v1::ClientMessage message, std::size_t cost);
    void onHello(const v1::Hello& hello);
    void admit(const v1::Hello& hello, v1::Role role);
    void rejectToken(bool guessed);
    void onView(const v1::View& view);
    void onAck(const v1::Ack& ack);
    void onCommand(v1::Command command, std::size_t cost);
    void onInvalidCommand(const Preview& preview, const Error& error);
    void refuse(std::uint64_t command, RejectReason cause, const std::string& reason, const std::string& field = "");
    void onControlRequest(const v1::ClientMessage& message);
    [[nodiscard]] std::string description() const;

    void queue(codec::SharedMessage message);
    void pump();
    void onWritten(ErrorCode error, std::size_t bytes);
    void onFrameLost();
    void requestKeyframe();
    void switchRendition(const std::string& reason);
    void reportStream(const std::string& reason);

    void startTimer();
    void onTimer(ErrorCode error);
    void ping();

    void close(boost::beast::websocket::close_code code, const std::string& reason, CloseCause cause);
    void abort(CloseCause cause);
    void finish(CloseCause cause);
    [[nodiscard]] CloseCause causeOf(ErrorCode error) const;

    // Keeps the session alive until the handler has run. An exception of the handler ends only this session.
    template <class Handler>
    auto protect(Handler handler) {
        return [self = shared_from_this(), handler = std::move(handler)](auto&&... results) mutable {
            try {
                handler(*self, std::forward<decltype(results)>(results)...);
            } catch (const std::exception& error) {
                self->fault(error);
            }
        };
    }
    template <class... Results>
    auto bind(void (Session::*method)(Results...)) {
        return protect([method](Session& self, Results... results) { (self.*method)(results...); });
    }
    void fault(const std::exception& error);

    ServerState& state_;
    boost::beast::websocket::stream<Transport, false> stream_;
    std::unique_ptr<ConnectionLimiter::Permit> permit_;
    std::string peer_;  // address
    boost::asio::steady_timer timer_;
    boost::asio::cancellation_signal cancelRead_;
    boost::asio::cancellation_signal cancelClose_;
    boost::beast::flat_buffer incoming_;
    SessionTimeouts timeouts_;
    LatestSlot<codec::EncodedFrame> offered_;
    SendQueue sendQueue_;
    AckWindow ackWindow_;
    RateController rateController_;
    codec::SharedMessage writing_;
    Encoding encoding_ = Encoding::Binary;
    TokenBucket commands_;
    TokenBucket views_;
    bool turns_ = false;                   // the client decodes frames with turns
    bool population_ = false;              // the client follows Population messages
    std::optional<v1::View> pendingView_;  // received too soon after others; applied later
    v1::Role role_ = v1::ROLE_UNSPECIFIED;
    SessionId id_ = 0;
    std::string client_ = "a client";
    CloseCause cause_ = CloseCause::Left;
    bool helloDone_ = false;
    bool tokenRejected_ = false;      // the session will close after guessDelay
    bool keyframeRequested_ = false;  // a keyframe is on its way
    bool pinging_ = false;
    bool draining_ = false;
    bool closing_ = false;  // a close frame is being sent: nothing else may be written
    bool finished_ = false;
};

}  // namespace spherule::net

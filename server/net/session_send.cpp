// The sending half of a session: queue, timer, close.
#include <utility>

#include <boost/asio/bind_cancellation_slot.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "net/sanitize.h"
#include "net/session.h"
#include "net/tcp_progress.h"

namespace spherule::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using websocket::close_code;
using Clock = RateController::Clock;

void Session::send(codec::SharedMessage message) {
    asio::post(stream_.get_executor(),
               protect([message = std::move(message)](Session& self) mutable { self.queue(std::move(message)); }));
}

// At most one frame waits for the io thread: a newer one replaces it.
void Session::offer(codec::EncodedFrame encoded) {
    if (offered_.set(std::move(encoded))) return;
    asio::post(stream_.get_executor(), protect([](Session& self) {
                   const auto newest = self.offered_.take();
                   if (self.closing_ || self.finished_) return;
                   // The request for a keyframe is over even if this is a delta frame: the delta frame has replaced
                   // the keyframe in offered_.
                   if (newest->rendition == self.rateController_.rendition()) self.keyframeRequested_ = false;
                   const auto offered = self.sendQueue_.offer(*newest);
                   if (offered == SendQueue::OfferResult::Busy) self.onFrameLost();
                   if (offered == SendQueue::OfferResult::Gap) ++self.state_.counters.chainsLost;
                   self.requestKeyframe();
                   self.pump();
               }));
}

// The client lost the chain: the previous frame was not sent in time, or the client could not decode it.
void Session::onFrameLost() {
    ++state_.counters.chainsLost;
    if (const auto reason = rateController_.onLoss(Clock::now())) switchRendition(*reason);
}

// Requests a keyframe only when it can be sent at once: a queued keyframe gets stale.
void Session::requestKeyframe() {
    if (keyframeRequested_ || writing_ || !sendQueue_.wantsKeyframe() || !ackWindow_.idle(Clock::now())) return;
    keyframeRequested_ = true;
    state_.hub.requestKeyframe(id_);
}

void Session::switchRendition(const std::string& reason) {
    const codec::Rendition rendition = rateController_.rendition();
    sendQueue_.follow(rendition);
    ackWindow_.setRate(rendition.rate);
    keyframeRequested_ = true;  // the hub sends a keyframe of the new rendition
    reportStream(reason);
    state_.hub.subscribe(id_, rendition);
}

void Session::reportStream(const std::string& reason) {
    const codec::Rendition rendition = rateController_.rendition();
    v1::ServerMessage message;
    message.mutable_stream()->set_tier(rendition.tier);
    message.mutable_stream()->set_rate(rendition.rate);
    message.mutable_stream()->set_reduced(rateController_.reduced());
    message.mutable_stream()->set_reason(reason);
    queue(codec::share(std::move(message)));
}

void Session::drain() {
    asio::post(stream_.get_executor(), protect([](Session& self) {
                   self.draining_ = true;
                   self.pump();
               }));
}

void Session::drop() {
    asio::post(stream_.get_executor(), protect([](Session& self) { self.abort(CloseCause::Drained); }));
}

void Session::queue(codec::SharedMessage message) {
    if (closing_ || finished_) return;
    if (!sendQueue_.push(std::move(message))) {
        return close(close_code::try_again_later, "too many messages wait for this client to read them",
                     CloseCause::Overflow);
    }
    if (sendQueue_.takeMissedChanges()) state_.hub.resendScene(id_);
    pump();
}

void Session::pump() {
    if (writing_ || closing_ || finished_ || !stream_.is_open()) return;
    if (draining_) sendQueue_.dropFrame();
    writing_ = sendQueue_.next(ackWindow_.open(Clock::now()));
    if (!writing_) {
        if (draining_) close(close_code::service_restart, "the server is stopping", CloseCause::Drained);
        return;
    }
    if (writing_->content().has_frame()) ackWindow_.sent(writing_->content().frame().sequence(), Clock::now());
    const bool text = encoding_ == Encoding::Text;
    stream_.text(text);
    timeouts_.writeBegan(Clock::now());
    stream_.async_write(asio::buffer(text ? writing_->json() : writing_->binary()), bind(&Session::onWritten));
}

void Session::onWritten(ErrorCode error, std::size_t bytes) {
    timeouts_.writeEnded();
    const auto written = std::exchange(writing_, nullptr);
    if (error) return;  // the pending read fails too, with a more precise error
    state_.counters.bytesSent += bytes;
    if (written->content().has_frame()) ++state_.counters.framesSent;
    requestKeyframe();
    pump();
}

void Session::startTimer() {
    timer_.expires_after(timeouts_.interval());
    timer_.async_wait(bind(&Session::onTimer));
}

void Session::onTimer(ErrorCode error) {
    if (error || finished_ || tokenRejected_) return;
    if (const auto requested = std::exchange(pendingView_, std::nullopt)) onView(*requested);
    if (const auto reason = rateController_.onTick(Clock::now())) switchRendition(*reason);
    requestKeyframe();
    pump();
    const auto progress = tcpProgress(beast::get_lowest_layer(stream_).socket().native_handle());
    switch (timeouts_.check(progress, Clock::now())) {
        case SessionTimeouts::Verdict::Fine:
            break;
        case SessionTimeouts::Verdict::Ping:
            ping();
            break;
        case SessionTimeouts::Verdict::NoHello:
            close(close_code::policy_error, "no hello came in time", CloseCause::NoHello);
            break;
        case SessionTimeouts::Verdict::Stalled:
            return abort(CloseCause::Stalled);
        case SessionTimeouts::Verdict::Silent:
            return abort(CloseCause::Silent);
    }
    startTimer();
}

void Session::ping() {
    if (pinging_ || closing_ || !stream_.is_open()) return;
    pinging_ = true;
    stream_.async_ping({}, [self = shared_from_this()](ErrorCode) { self->pinging_ = false; });
}

void Session::close(close_code code, const std::string& reason, CloseCause cause) {
    if (closing_ || finished_) return;
    closing_ = true;
    cause_ = cause;
    sendQueue_.clear();
    timeouts_.closeBegan(Clock::now());
    if (!stream_.is_open()) return finish(cause);
    stream_.async_close({code, closeReason(reason)},
                        asio::bind_cancellation_slot(
                            cancelClose_.slot(), protect([](Session& self, ErrorCode) { self.finish(self.cause_); })));
}

void Session::fault(const std::exception& error) {
    abort(CloseCause::Fault);
    state_.rejectionLog.rejected(RejectReason::Fault, description() + ": " + error.what());
}

// Resets the connection of a peer that does not read: a close frame would wait behind the unsent data. Cancels Beast's
// read and close, which wait for each other forever if the peer breaks the protocol during the closing handshake.
void Session::abort(CloseCause cause) {
    if (finished_) return;
    // A cancelled read may end before emit() returns, and finishes the session with this cause.
    if (!std::exchange(closing_, true)) cause_ = cause;
    ErrorCode ignored;
    beast::get_lowest_layer(stream_).socket().set_option(asio::socket_base::linger(true, 0), ignored);
    cancelRead_.emit(asio::cancellation_type::terminal);
    cancelClose_.emit(asio::cancellation_type::terminal);
    finish(cause_);
}

}  // namespace spherule::net

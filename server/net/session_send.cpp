// The sending half of a session: its lanes, its clock, its end.
#include <utility>

#include <boost/asio/bind_cancellation_slot.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "net/session.h"
#include "net/tcp_progress.h"
#include "net/text.h"

namespace spherule::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using websocket::close_code;
using Clock = Pace::Clock;

void Session::send(codec::SharedMessage message) {
    asio::post(stream_.get_executor(),
               guarded([message = std::move(message)](Session& self) mutable { self.queue(std::move(message)); }));
}

// However long the io thread is busy, one frame waits for it, not a row of them.
void Session::offer(codec::EncodedFrame encoded) {
    if (offered_.put(std::move(encoded))) return;
    asio::post(stream_.get_executor(), guarded([](Session& self) {
                   const auto newest = self.offered_.take();
                   if (self.closing_ || self.finished_) return;
                   // A delta comes to who needs no keyframe, or is newer than the keyframe, which it has replaced on
                   // its way here.
                   if (newest->rendition == self.pace_.rendition()) self.asked_ = false;
                   const auto offered = self.outbox_.offer(*newest);
                   if (offered == Outbox::Offered::Busy) self.missed();
                   if (offered == Outbox::Offered::Gap) ++self.context_.counters.chainsLost;
                   self.askKeyframe();
                   self.pump();
               }));
}

// The client lost the chain, because it did not take the frame before or could not decode it.
void Session::missed() {
    ++context_.counters.chainsLost;
    if (const auto reason = pace_.lost(Clock::now())) follow(*reason);
}

// Only when it can go at once, and alone: what waits gets old, here as on the way to a slow client.
void Session::askKeyframe() {
    if (asked_ || writing_ || !outbox_.wantsKeyframe() || !credit_.idle(Clock::now())) return;
    asked_ = true;
    context_.hub.askKeyframe(id_);
}

void Session::follow(const std::string& reason) {
    const codec::Rendition rendition = pace_.rendition();
    outbox_.follow(rendition);
    credit_.setRate(rendition.rate);
    asked_ = true;  // who comes to a chain is sent a keyframe of it
    sayStream(reason);
    context_.hub.watch(id_, rendition);
}

void Session::sayStream(const std::string& reason) {
    const codec::Rendition rendition = pace_.rendition();
    v1::ServerMessage message;
    message.mutable_stream()->set_tier(rendition.tier);
    message.mutable_stream()->set_rate(rendition.rate);
    message.mutable_stream()->set_reduced(pace_.reduced());
    message.mutable_stream()->set_reason(reason);
    queue(codec::share(std::move(message)));
}

void Session::drain() {
    asio::post(stream_.get_executor(), guarded([](Session& self) {
                   self.draining_ = true;
                   self.pump();
               }));
}

void Session::drop() {
    asio::post(stream_.get_executor(), guarded([](Session& self) { self.abort(CloseCause::Drained); }));
}

void Session::queue(codec::SharedMessage message) {
    if (closing_ || finished_) return;
    if (!outbox_.push(std::move(message))) {
        return close(close_code::try_again_later, "too many messages wait for this client to read them",
                     CloseCause::Overflow);
    }
    pump();
}

void Session::pump() {
    if (writing_ || closing_ || finished_ || !stream_.is_open()) return;
    if (draining_) outbox_.dropFrame();
    writing_ = outbox_.next(credit_.open(Clock::now()));
    if (!writing_) {
        if (draining_) close(close_code::service_restart, "the server is stopping", CloseCause::Drained);
        return;
    }
    if (writing_->content().has_frame()) credit_.sent(writing_->content().frame().sequence(), Clock::now());
    const bool text = encoding_ == Encoding::Text;
    stream_.text(text);
    liveness_.writeBegan(Clock::now());
    stream_.async_write(asio::buffer(text ? writing_->json() : writing_->binary()), bind(&Session::onWritten));
}

void Session::onWritten(ErrorCode error, std::size_t bytes) {
    liveness_.writeEnded();
    const auto written = std::exchange(writing_, nullptr);
    if (error) return;  // the read under way fails too, and knows more
    context_.counters.bytesSent += bytes;
    if (written->content().has_frame()) ++context_.counters.framesSent;
    askKeyframe();
    pump();
}

void Session::watch() {
    watchTimer_.expires_after(liveness_.interval());
    watchTimer_.async_wait(bind(&Session::onWatch));
}

void Session::onWatch(ErrorCode error) {
    if (error || finished_ || turnedAway_) return;
    if (const auto wish = std::exchange(wish_, std::nullopt)) onView(*wish);
    if (const auto reason = pace_.passed(Clock::now())) follow(*reason);
    askKeyframe();
    pump();
    const auto progress = tcpProgress(beast::get_lowest_layer(stream_).socket().native_handle());
    switch (liveness_.check(progress, Clock::now())) {
        case Liveness::Verdict::Fine:
            break;
        case Liveness::Verdict::Ping:
            ping();
            break;
        case Liveness::Verdict::NoHello:
            close(close_code::policy_error, "no hello came in time", CloseCause::NoHello);
            break;
        case Liveness::Verdict::Stalled:
            return abort(CloseCause::Stalled);
        case Liveness::Verdict::Silent:
            return abort(CloseCause::Silent);
    }
    watch();
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
    outbox_.clear();
    liveness_.closeBegan(Clock::now());
    if (!stream_.is_open()) return finish(cause);
    stream_.async_close({code, closeReason(reason)},
                        asio::bind_cancellation_slot(
                            endOfClose_.slot(), guarded([](Session& self, ErrorCode) { self.finish(self.cause_); })));
}

void Session::fault(const std::exception& error) {
    abort(CloseCause::Fault);
    context_.refusals.add(Rejection::Fault, who() + ": " + error.what());
}

// For a peer that does not take what is sent: a close frame would wait behind it, and so would the kernel's copy.
// Beast's read and close wait for each other for ever when the peer breaks the protocol as it is told goodbye, and no
// end of the socket ends them.
void Session::abort(CloseCause cause) {
    if (finished_) return;
    ErrorCode ignored;
    beast::get_lowest_layer(stream_).socket().set_option(asio::socket_base::linger(true, 0), ignored);
    endOfRead_.emit(asio::cancellation_type::terminal);
    endOfClose_.emit(asio::cancellation_type::terminal);
    finish(closing_ ? cause_ : cause);
}

}  // namespace spherule::net

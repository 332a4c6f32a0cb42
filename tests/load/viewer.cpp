#include "viewer.h"

#include <algorithm>
#include <deque>
#include <utility>

#include <spdlog/fmt/fmt.h>
#include <boost/asio/buffer.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

namespace spherule::load {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

namespace {

constexpr std::size_t largestMessage = std::size_t{256} << 20U;
constexpr std::size_t slowPiece = 4096;  // bytes per read of a slow viewer
constexpr int slowBuffer =
    16 * 1024;  // receive buffer of the kernel (bytes): small, so that the kernel does not read ahead
constexpr auto rejoinAfter = 500ms;
constexpr auto longestGap = 5s;  // allowed between frames of a healthy viewer, also on a busy machine

std::uint64_t microsecondsNow() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

}  // namespace

struct Viewer::Session {
    Session(asio::io_context& io, bool decode) : stream(io), timer(io), lateTimer(io), check(decode) {}

    websocket::stream<beast::tcp_stream, false> stream;
    asio::steady_timer timer;      // for the next read, or for the disconnect
    asio::steady_timer lateTimer;  // for the next late ack
    beast::flat_buffer incoming;
    std::deque<std::string> outgoing;
    std::deque<std::pair<Clock::time_point, std::uint64_t>> lateAcks;
    ChainCheck check;
    bool over = false;
};

Viewer::Viewer(asio::io_context& io, const Wish& wish, Kind kind, std::uint32_t index, bool decode)
    : io_(io), wish_(wish), kind_(kind), index_(index), decode_(decode), restart_(io) {
    tally_.viewers = 1;
}

Viewer::~Viewer() = default;

void Viewer::start(std::chrono::milliseconds after) {
    again(after);
}

void Viewer::again(std::chrono::milliseconds after) {
    restart_.expires_after(after);
    restart_.async_wait([this](ErrorCode error) {
        if (!error) connect();
    });
}

bool Viewer::measuring() const {
    return Clock::now() >= wish_.measureFrom;
}

void Viewer::connect() {
    session_ = std::make_shared<Session>(io_, decode_);
    ++sessions_;
    ++tally_.joins;
    auto& lowest = beast::get_lowest_layer(session_->stream);
    ErrorCode ignored;
    lowest.socket().open(wish_.server.protocol(), ignored);
    lowest.socket().set_option(tcp::no_delay(true), ignored);
    // Set before connecting: the size limits the TCP window.
    if (kind_ == Kind::SlowReading || kind_ == Kind::Stalled)
        lowest.socket().set_option(asio::socket_base::receive_buffer_size(slowBuffer), ignored);
    lowest.async_connect(wish_.server, [this, session = session_](ErrorCode error) {
        if (error) return ended(session, "connect: " + error.message(), false);
        handshake(session);
    });
}

void Viewer::handshake(const SharedSession& session) {
    session->stream.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
        request.set(beast::http::field::sec_websocket_protocol, "spherule.v1");
    }));
    session->stream.read_message_max(largestMessage);
    session->stream.binary(true);
    session->stream.async_handshake(wish_.url.host + ":" + wish_.url.port, wish_.url.path,
                                    [this, session](ErrorCode error) {
                                        if (error) return ended(session, "handshake: " + error.message(), false);
                                        hello(session);
                                        read(session);
                                        if (kind_ == Kind::Reconnecting) leaveSoon(session);
                                    });
}

void Viewer::hello(const SharedSession& session) {
    v1::ClientMessage message;
    message.mutable_hello()->set_client(fmt::format("load {} {}", kindNames[static_cast<std::size_t>(kind_)], index_));
    message.mutable_hello()->set_token(wish_.token);
    v1::View& view = *message.mutable_hello()->mutable_view();
    view.set_rate(wish_.rate);
    view.set_tier(wish_.tier);
    view.set_fixed(wish_.fixed);
    send(session, message);
}

void Viewer::read(const SharedSession& session) {
    const auto done = [this, session](ErrorCode error, std::size_t bytes) { onRead(session, error, bytes); };
    if (kind_ == Kind::SlowReading) {
        session->stream.async_read_some(session->incoming, slowPiece, done);
    } else {
        session->stream.async_read(session->incoming, done);
    }
}

void Viewer::onRead(const SharedSession& session, ErrorCode error, std::size_t bytes) {
    if (session->over) return;
    if (error == websocket::error::closed) {
        const auto& said = session->stream.reason();
        return ended(session, fmt::format("{} {}", static_cast<unsigned>(said.code), said.reason.c_str()), false);
    }
    if (error) return ended(session, "no close frame: " + error.message(), false);
    if (measuring()) tally_.bytes += bytes;
    if (session->stream.is_message_done()) {
        take(session);
        session->incoming.clear();
        if (session->over) return;
        if (kind_ == Kind::Stalled && session->check.received().frames > 0) return awaitDrop(session);
    }
    if (kind_ != Kind::SlowReading) return read(session);
    session->timer.expires_after(1us * (1'000'000 * bytes / wish_.slowBytes));
    session->timer.async_wait([this, session](ErrorCode stopped) {
        if (!stopped && !session->over) read(session);
    });
}

void Viewer::take(const SharedSession& session) {
    const std::uint64_t now = microsecondsNow();
    const auto bytes = session->incoming.cdata();
    v1::ServerMessage message;
    if (!session->stream.got_binary() || !message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
        return tally_.fault("a message that does not parse");
    const auto fault = session->check.take(message);
    if (fault) tally_.fault(fmt::format("{} {}: {}", kindNames[static_cast<std::size_t>(kind_)], index_, *fault));
    if (!message.has_frame()) return;
    if (fault) return ack(session, message.frame().sequence(), true);
    onFrame(session, message.frame(), now);
}

void Viewer::onFrame(const SharedSession& session, const v1::Frame& frame, std::uint64_t now) {
    const auto moment = Clock::now();
    if (kind_ == Kind::Healthy && lastFrame_ != Clock::time_point{} && moment - lastFrame_ > longestGap)
        tally_.fault(fmt::format("healthy {}: no frame for {:.1f} s", index_,
                                 std::chrono::duration<double>(moment - lastFrame_).count()));
    lastFrame_ = moment;
    if (measuring()) {
        ++tally_.frames;
        tally_.ages.push_back(static_cast<std::uint32_t>(now > frame.stamp_us() ? now - frame.stamp_us() : 0));
    }
    if (kind_ != Kind::LateAcking) return ack(session, frame.sequence(), false);
    session->lateAcks.emplace_back(moment + wish_.lateAck, frame.sequence());
    if (session->lateAcks.size() == 1) ackLate(session);
}

void Viewer::ackLate(const SharedSession& session) {
    session->lateTimer.expires_at(session->lateAcks.front().first);
    session->lateTimer.async_wait([this, session](ErrorCode error) {
        if (error || session->over) return;
        ack(session, session->lateAcks.front().second, false);
        session->lateAcks.pop_front();
        if (!session->lateAcks.empty()) ackLate(session);
    });
}

void Viewer::ack(const SharedSession& session, std::uint64_t sequence, bool lost) {
    v1::ClientMessage message;
    message.mutable_ack()->set_sequence(sequence);
    message.mutable_ack()->set_lost(lost);
    send(session, message);
}

void Viewer::send(const SharedSession& session, const v1::ClientMessage& message) {
    session->outgoing.push_back(message.SerializeAsString());
    if (session->outgoing.size() == 1) write(session);
}

void Viewer::write(const SharedSession& session) {
    session->stream.async_write(asio::buffer(session->outgoing.front()), [this, session](ErrorCode error, std::size_t) {
        if (error || session->over) return;  // the pending read fails too, with a more precise error
        session->outgoing.pop_front();
        if (!session->outgoing.empty()) write(session);
    });
}

// Nothing is read any more, so only an error of the socket shows that the server has dropped the connection.
void Viewer::awaitDrop(const SharedSession& session) {
    beast::get_lowest_layer(session->stream).socket().async_wait(tcp::socket::wait_error, [this, session](ErrorCode) {
        ended(session, "dropped, as it must be", false);
    });
}

void Viewer::leaveSoon(const SharedSession& session) {
    // Between 1/5 of the longest stay and all of it; different for each viewer and session.
    const auto longest = std::chrono::duration_cast<std::chrono::milliseconds>(wish_.stay);
    session->timer.expires_after(longest * (1 + (7 * index_ + 3 * sessions_) % 5) / 5);
    session->timer.async_wait([this, session](ErrorCode error) {
        if (error || session->over) return;
        if (sessions_ % 2 == 0) return ended(session, "", true);
        session->stream.async_close(websocket::close_code::going_away, [session](ErrorCode) {});
        // The handler keeps the old connection until the server has answered; the viewer opens a new one meanwhile.
        tally_.received += session->check.received();
        session->over = true;
        again(0ms);
    });
}

void Viewer::ended(const SharedSession& session, const std::string& how, bool own) {
    if (session->over) return;
    session->over = true;
    tally_.received += session->check.received();
    session->timer.cancel();
    session->lateTimer.cancel();
    beast::get_lowest_layer(session->stream).close();
    if (!own) {
        ++tally_.ends[how];
        if (kind_ == Kind::Healthy) tally_.fault(fmt::format("healthy {}: disconnected: {}", index_, how));
    }
    again(own ? 0ms : rejoinAfter);
}

void Viewer::conclude() {
    if (session_ && !session_->over) {
        session_->over = true;
        tally_.received += session_->check.received();
    }
    if (kind_ != Kind::Healthy) return;
    if (tally_.received.frames == 0) return tally_.fault(fmt::format("healthy {}: no frame at all", index_));
    const auto silence = Clock::now() - lastFrame_;
    if (silence > longestGap)
        tally_.fault(fmt::format("healthy {}: no frame in the last {:.1f} s", index_,
                                 std::chrono::duration<double>(silence).count()));
}

}  // namespace spherule::load

#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "chain_check.h"
#include "client/client.h"
#include "client/url.h"
#include "tally.h"

namespace spherule::load {

// Settings shared by all viewers.
struct Wish {
    boost::asio::ip::tcp::endpoint server;
    client::Url url;
    std::string token{};
    v1::Tier tier = v1::NORMAL;
    std::uint32_t rate = 20;
    bool fixed = false;
    std::size_t slowBytes = 20'000;  // per second
    std::chrono::milliseconds lateAck{1000};
    std::chrono::seconds stay{3};  // longest session of a reconnecting viewer
    std::chrono::steady_clock::time_point measureFrom;
};

// One viewer, which connects again when it is dropped. Used on the thread of its io_context.
class Viewer {
  public:
    Viewer(boost::asio::io_context& io, const Wish& wish, Kind kind, std::uint32_t index, bool decode);
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    void start(std::chrono::milliseconds after);
    // Checks that the viewer has received frames; call once, before tally().
    void conclude();

    [[nodiscard]] Kind kind() const { return kind_; }
    [[nodiscard]] const Tally& tally() const { return tally_; }

  private:
    // One connection and its state. A handler that runs after the viewer has replaced it does nothing.
    struct Session;
    using SharedSession = std::shared_ptr<Session>;
    using ErrorCode = boost::beast::error_code;

    void connect();
    void handshake(const SharedSession& session);
    void hello(const SharedSession& session);
    void read(const SharedSession& session);
    void onRead(const SharedSession& session, ErrorCode error, std::size_t bytes);
    void take(const SharedSession& session);
    void onFrame(const SharedSession& session, const v1::Frame& frame, std::uint64_t now);
    void ack(const SharedSession& session, std::uint64_t sequence, bool lost);
    void ackLate(const SharedSession& session);
    void send(const SharedSession& session, const v1::ClientMessage& message);
    void write(const SharedSession& session);
    void awaitDrop(const SharedSession& session);
    void leaveSoon(const SharedSession& session);
    void ended(const SharedSession& session, const std::string& how, bool own);
    void again(std::chrono::milliseconds after);
    [[nodiscard]] bool measuring() const;

    boost::asio::io_context& io_;
    const Wish& wish_;
    const Kind kind_;
    const std::uint32_t index_;
    const bool decode_;
    SharedSession session_;
    boost::asio::steady_timer restart_;
    std::uint32_t sessions_ = 0;
    std::chrono::steady_clock::time_point lastFrame_{};
    Tally tally_;
};

}  // namespace spherule::load

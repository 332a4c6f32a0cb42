// Fuzzes HttpConnection and Session over a pair of sockets. The first byte selects a prefix, because a fuzzer finds
// neither a handshake nor a mask by itself.
//
// Bit 0: the server requires tokens.
//
// Bit 1: an upgrade to the stream. The rest is WebSocket frames, each with its first byte, two bytes of length and a
// payload, which is masked here.
//
// Bit 2: a hello after the upgrade.
//
// Bit 3: the client disconnects at once, not only when the server waits for it.
//
// After the disconnect, all operations of the server must end.
#include <fcntl.h>
#include <google/protobuf/stubs/logging.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/strand.hpp>

#include "core/log.h"
#include "net/http.h"

namespace {

using namespace spherule;
using namespace std::chrono_literals;
namespace asio = boost::asio;

constexpr std::string_view token = "0123456789abcdef";
constexpr std::string_view upgrade =
    "GET /ws HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Protocol: spherule.v1\r\n\r\n";

const net::StaticFile file = {"text/css", {"plain", "\"p\""}, {"compressed", "\"c\""}};

void require(bool holds) {
    if (!holds) std::abort();
}

std::string framed(std::uint8_t first, std::string_view content) {
    constexpr std::size_t shortest = 126;  // shortest payload with a length of two bytes
    std::string frame{static_cast<char>(first)};
    const std::size_t length = content.size();
    frame += static_cast<char>(0x80U | std::min(length, shortest));
    if (length >= shortest) {
        frame += static_cast<char>(length >> 8U);
        frame += static_cast<char>(length & 0xffU);
    }
    frame.append(4, '\0');  // the mask
    return frame.append(content);
}

std::string hello() {
    v1::ClientMessage message;
    message.mutable_hello()->set_client("fuzz");
    message.mutable_hello()->set_token(std::string(token));
    message.mutable_hello()->mutable_view()->set_rate(30);
    return framed(0x82, message.SerializeAsString());
}

std::string framesOf(std::uint8_t how, std::string_view rest) {
    std::string sent = (how & 4U) != 0 ? hello() : "";
    while (rest.size() >= 3) {
        const auto number = [&](std::size_t at) { return static_cast<std::uint8_t>(rest[at]); };
        const std::size_t length = std::min<std::size_t>(number(1) + 256U * number(2), rest.size() - 3);
        sent += framed(number(0), rest.substr(3, length));
        rest.remove_prefix(3 + length);
    }
    return sent;
}

// The server without its listener: one connection, on this thread.
class Served {
  public:
    explicit Served(int socket) {
        const auto address = asio::ip::make_address("127.0.0.1");
        require(!state_.limiter->refuses(address, net::ConnectionLimiter::Clock::now()));
        asio::ip::tcp::socket end(asio::make_strand(io_), asio::ip::tcp::v4(), socket);
        std::make_shared<net::HttpConnection>(net::Transport(boost::beast::tcp_stream(std::move(end)), nullptr),
                                              state_.limiter->admit(address), "127.0.0.1", state_)
            ->run();
    }

    void wantTokens() {
        state_.admission = std::make_shared<net::Admission>(
            net::AllowedNames{}, net::Credentials{.controllerToken = std::string(token)}, "http");
    }

    // Returns false when no handler is ready.
    bool work() { return io_.poll() > 0; }
    bool wait() { return io_.run_one_for(100ms) > 0; }
    [[nodiscard]] bool ended() const { return io_.stopped(); }
    [[nodiscard]] bool isEmpty() { return state_.counters.sessions == 0 && state_.hub.waitEmpty(0ms); }

  private:
    net::Options options() {
        net::Options options;
        options.guessDelay = 0ms;
        return options;
    }

    net::Handlers handlers() {
        return {.welcome = [](const v1::Hello&) { return v1::Welcome(); },
                .submit =
                    [this](net::SessionId session, const v1::Command& command, std::size_t) {
                        v1::ServerMessage message;
                        message.mutable_result()->set_id(command.id());
                        state_.hub.sendTo(session, codec::share(std::move(message)));
                        sendFrames();
                        return command.has_reset() ? std::optional<std::string>("the queue is full") : std::nullopt;
                    },
                .file = [](const std::string& path) { return path == "/file" ? &file : nullptr; },
                .get = [](const std::string& path, const net::Counters&) -> net::HttpAnswer {
                    if (path != "/") return {.status = 404, .contentType = "text/plain", .body = "nothing\n"};
                    return {.contentType = "text/html", .body = std::string(10'000, ' ')};
                }};
    }

    void sendFrames() {
        for (const codec::Subscription& subscription : state_.hub.subscriptions()) {
            v1::ServerMessage message;
            message.mutable_frame()->set_sequence(++frames_);
            message.mutable_frame()->set_tier(subscription.rendition.tier);
            state_.hub.publish({.rendition = subscription.rendition,
                                .kind = codec::EncodedFrame::Kind::Keyframe,
                                .number = frames_,
                                .message = codec::share(std::move(message))});
        }
    }

    asio::io_context io_{1};
    std::uint32_t frames_ = 0;
    net::ServerState state_{
        .options = options(),
        .handlers = handlers(),
        .admission = std::make_shared<net::Admission>(net::AllowedNames{}, net::Credentials{}, "http")};
};

// The client's end of the connection.
class Client {
  public:
    explicit Client(int socket) : socket_(socket) {}
    ~Client() { close(socket_); }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    void say(std::string_view more) { left_ += more; }

    // Writes and reads without blocking. Returns false when no byte was transferred.
    bool work() {
        const ssize_t written = left_.empty() ? 0 : ::send(socket_, left_.data(), left_.size(), MSG_NOSIGNAL);
        if (written > 0) left_.erase(0, static_cast<std::size_t>(written));
        std::array<char, 65536> taken{};
        const ssize_t read = ::recv(socket_, taken.data(), taken.size(), 0);
        return written > 0 || read > 0;
    }

    void leave() { shutdown(socket_, SHUT_WR); }

  private:
    int socket_;
    std::string left_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const auto quiet = google::protobuf::SetLogHandler(nullptr);
    (void)quiet;
    spdlog::set_level(spdlog::level::off);
    if (size == 0) return 0;
    std::array<int, 2> ends{};
    require(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) == 0);
    Client client(ends[0]);
    Served served(ends[1]);
    if ((data[0] & 1U) != 0) served.wantTokens();
    const auto workOn = [&](bool servedToo) {
        for (bool worked = true; worked;) {
            worked = client.work();
            if (servedToo && served.work()) worked = true;
        }
    };
    const std::string_view rest(reinterpret_cast<const char*>(data + 1), size - 1);
    const bool upgrades = (data[0] & 2U) != 0;
    if (upgrades) {
        client.say(upgrade);
        workOn(true);  // frames may be sent only after the answer
    }
    client.say(upgrades ? framesOf(data[0], rest) : rest);
    workOn((data[0] & 8U) == 0);
    client.leave();
    for (int waits = 0; !served.ended();) {
        const bool read = client.work();
        if (served.work() || read || served.ended()) continue;
        require(++waits <= 3 && served.wait());  // for guessDelay, not longer
    }
    require(served.isEmpty());
    return 0;
}

// All operations of a session end with it. Each test serves one connection over a pair of sockets. If an operation has
// not ended, the io_context still has work.
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/strand.hpp>

#include "net/http.h"

namespace spherule::net {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;
namespace asio = boost::asio;

constexpr std::string_view upgrade =
    "GET /ws HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Protocol: spherule.v1\r\n\r\n";

class SessionEnd : public testing::Test {
  protected:
    SessionEnd() {
        if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends_.data()) != 0)
            throw std::runtime_error("no pair of sockets");
        const auto address = asio::ip::make_address("127.0.0.1");
        if (state_.limiter->refuses(address, ConnectionLimiter::Clock::now())) throw std::runtime_error("refused");
        asio::ip::tcp::socket socket(asio::make_strand(io_), asio::ip::tcp::v4(), ends_[1]);
        std::make_shared<HttpConnection>(Transport(boost::beast::tcp_stream(std::move(socket)), nullptr),
                                         state_.limiter->admit(address), "127.0.0.1", state_)
            ->run();
    }
    ~SessionEnd() override { close(ends_[0]); }

    void send(std::string_view bytes) {
        ASSERT_EQ(::send(ends_[0], bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
    }
    // Serves until the server has sent this text.
    void await(std::string_view what) {
        while (said_.find(what) == std::string::npos && io_.run_one_for(10s) > 0) {
            std::array<char, 4096> bytes{};
            const ssize_t length = ::recv(ends_[0], bytes.data(), bytes.size(), 0);
            if (length > 0) said_.append(bytes.data(), static_cast<std::size_t>(length));
        }
        ASSERT_NE(said_.find(what), std::string::npos);
    }
    void openStream() {
        send(upgrade);
        await("\r\n\r\n");
    }
    // Serves until no work is left, or for 10 s.
    void expectEnd() {
        io_.run_for(10s);
        EXPECT_TRUE(io_.stopped()) << "an operation never ended";
        EXPECT_EQ(state_.counters.sessions, 0U);
    }

    static Options quick() {
        Options options;
        options.helloTimeout = 500ms;
        options.progressTimeout = 300ms;
        return options;
    }

    ServerState state_{.options = quick(),
                       .handlers = {},
                       .admission = std::make_shared<Admission>(AllowedNames{}, Credentials{}, "http")};
    asio::io_context io_{1};  // last: pending operations refer to the state
    std::array<int, 2> ends_{};
    std::string said_;
};

TEST_F(SessionEnd, WhenThePeerViolatesTheProtocolDuringTheCloseHandshake) {
    openStream();
    send("\x82\x83\0\0\0\0\xff\xff\xff\xf0\x80\0\0\0\0"s);
    expectEnd();
}

TEST_F(SessionEnd, WhenThePeerViolatesTheProtocolWithinAMessage) {
    openStream();
    send("\x81\x8a\0\0\0\0a"s);
    await("no hello came in time");
    send("\xc3\xc3\xc3\xc3\xc3\xc3\xc3\xc3\xc3");  // invalid UTF-8
    expectEnd();
}

TEST_F(SessionEnd, WhenThePeerNeitherReadsNorCloses) {
    openStream();
    expectEnd();
}

}  // namespace
}  // namespace spherule::net

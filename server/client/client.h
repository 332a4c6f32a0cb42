#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"
#include "net/decode.h"
#include "spherule/v1/control.pb.h"

namespace spherule::client {

// How the connection ended: the server's close frame, or code 1006 when there was none.
struct CloseFrame {
    std::uint16_t code = 0;
    std::string reason;
};

// A small WebSocket client that waits. One thread. It answers pings only within receive().
class Client {
  public:
    using Timeout = std::chrono::milliseconds;

    // Whom `authorities` (PEM) certify is trusted, or, without any, whom the system trusts; the certificate must be the
    // host's.
    static Result<std::unique_ptr<Client>> connect(const std::string& url, Timeout timeout,
                                                   const std::string& subprotocol = "spherule.v1",
                                                   const std::string& authorities = "");
    ~Client();
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    Result<void> send(const v1::ClientMessage& message, net::Encoding encoding = net::Encoding::Binary);
    Result<void> sendBytes(std::string_view bytes, net::Encoding encoding);

    // The next message, in either encoding; nothing when none came in time; an error when the connection has ended.
    Result<std::optional<v1::ServerMessage>> receive(Timeout timeout);

    // How the last message came.
    [[nodiscard]] net::Encoding receivedAs() const;
    [[nodiscard]] const std::optional<CloseFrame>& closed() const;

    // Says goodbye; waits for the answer as long as for connecting.
    void close();

  private:
    struct Connection;
    explicit Client(std::unique_ptr<Connection> connection);

    std::unique_ptr<Connection> connection_;
};

}  // namespace spherule::client

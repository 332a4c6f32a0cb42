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

// The server's close frame; code 1006 if there was none.
struct CloseFrame {
    std::uint16_t code = 0;
    std::string reason;
};

// A blocking WebSocket client. Used by one thread. Answers pings only during receive().
class Client {
  public:
    using Timeout = std::chrono::milliseconds;

    // Connects to a ws:// or wss:// URL. `timeout`: for each step. `authorities`: trusted certificates (PEM); if empty,
    // the authorities of the system. Input for an invalid URL, Refused if the server is unreachable or not a spherule
    // server.
    static Result<std::unique_ptr<Client>> connect(const std::string& url, Timeout timeout,
                                                   const std::string& subprotocol = "spherule.v1",
                                                   const std::string& authorities = "");
    ~Client();
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    Result<void> send(const v1::ClientMessage& message, net::Encoding encoding = net::Encoding::Binary);
    Result<void> sendBytes(std::string_view bytes, net::Encoding encoding);

    // Returns the next message, in either encoding; nullopt after `timeout`; Refused when the connection has ended.
    Result<std::optional<v1::ServerMessage>> receive(Timeout timeout);

    // Encoding of the last message.
    [[nodiscard]] net::Encoding receivedAs() const;
    [[nodiscard]] const std::optional<CloseFrame>& closed() const;

    // Closes the connection and waits for the server's close frame, up to the timeout of connect().
    void close();

  private:
    struct Connection;
    explicit Client(std::unique_ptr<Connection> connection);

    std::unique_ptr<Connection> connection_;
};

}  // namespace spherule::client

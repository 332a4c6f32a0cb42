#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace spherule::net {

// A TCP connection to 127.0.0.1 that waits at most ten seconds, for what a well-behaved client would not do.
class RawSocket {
  public:
    // `receiveBuffer` in bytes; 0: the kernel's choice.
    explicit RawSocket(std::uint16_t port, int receiveBuffer = 0);
    ~RawSocket();
    RawSocket(const RawSocket&) = delete;
    RawSocket& operator=(const RawSocket&) = delete;

    void send(std::string_view bytes) const;
    // Some bytes, `most` at most; none at the end of the stream, after an error or when the time is over.
    [[nodiscard]] std::string readSome(std::size_t most = 65536) const;
    // Throws away what has come, without waiting for more.
    void drain() const;
    // Until `end` has come, or the stream has ended.
    [[nodiscard]] std::string readUntil(std::string_view end) const;
    [[nodiscard]] std::string readAll() const;

    // Upgrades to the stream; the response's head.
    [[nodiscard]] std::string openStream() const;
    // A masked frame of up to 125 bytes with the given first byte, as RFC 6455 5.2 draws it.
    void sendFrame(std::uint8_t firstByte, std::string_view payload) const;

  private:
    int socket_;
};

}  // namespace spherule::net

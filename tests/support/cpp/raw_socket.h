#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace spherule::net {

// A TCP connection to 127.0.0.1 for tests of misbehaving clients. Each call blocks at most 10 s.
class RawSocket {
  public:
    // `receiveBuffer` in bytes; 0: the kernel's choice.
    explicit RawSocket(std::uint16_t port, int receiveBuffer = 0);
    ~RawSocket();
    RawSocket(const RawSocket&) = delete;
    RawSocket& operator=(const RawSocket&) = delete;

    void send(std::string_view bytes) const;
    // Returns 1 to `most` bytes; none at the end of the stream, after an error or a timeout.
    [[nodiscard]] std::string readSome(std::size_t most = 65536) const;
    // Discards the received bytes without blocking.
    void drain() const;
    // Reads until `end` has come, or the stream has ended.
    [[nodiscard]] std::string readUntil(std::string_view end) const;
    [[nodiscard]] std::string readAll() const;

    // Upgrades to the stream and returns the head of the response.
    [[nodiscard]] std::string openStream() const;
    // Sends a masked frame of up to 125 bytes with the given first byte (RFC 6455, 5.2).
    void sendFrame(std::uint8_t firstByte, std::string_view payload) const;

  private:
    int socket_;
};

}  // namespace spherule::net

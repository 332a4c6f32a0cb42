#include "raw_socket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace spherule::net {

RawSocket::RawSocket(std::uint16_t port, int receiveBuffer) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval limit{.tv_sec = 10, .tv_usec = 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    if (receiveBuffer > 0) setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receiveBuffer, sizeof receiveBuffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        ::close(socket_);
        throw std::runtime_error("no connection");
    }
}

RawSocket::~RawSocket() {
    ::close(socket_);
}

void RawSocket::send(std::string_view bytes) const {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent <= 0) return;  // the server may close at any time; tests check its answers
        bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
}

std::string RawSocket::readSome(std::size_t most) const {
    std::string bytes(most, '\0');
    const ssize_t received = ::recv(socket_, bytes.data(), bytes.size(), 0);
    bytes.resize(received > 0 ? static_cast<std::size_t>(received) : 0);
    return bytes;
}

void RawSocket::drain() const {
    std::array<char, 65536> bytes{};
    while (::recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT) == static_cast<ssize_t>(bytes.size())) {
    }
}

std::string RawSocket::readUntil(std::string_view end) const {
    std::string all;
    while (all.find(end) == std::string::npos) {
        const std::string some = readSome(1);
        if (some.empty()) break;
        all += some;
    }
    return all;
}

std::string RawSocket::readAll() const {
    std::string all;
    for (std::string some = readSome(); !some.empty(); some = readSome()) all += some;
    return all;
}

std::string RawSocket::openStream() const {
    send(
        "GET /ws HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Protocol: spherule.v1\r\n\r\n");
    return readUntil("\r\n\r\n");
}

void RawSocket::sendFrame(std::uint8_t firstByte, std::string_view payload) const {
    constexpr std::uint8_t masked = 0x80;
    const std::string noMask(4, '\0');
    std::string frame;
    frame += static_cast<char>(firstByte);
    frame += static_cast<char>(masked | static_cast<std::uint8_t>(payload.size()));
    frame += noMask;
    frame += payload;
    send(frame);
}

}  // namespace spherule::net

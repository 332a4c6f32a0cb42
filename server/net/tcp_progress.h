#pragma once

#include <cstdint>

namespace spherule::net {

// Bytes transferred over a connection since it was opened, as counted by the kernel. A completed write shows only that
// the kernel's buffer had room.
struct TcpProgress {
    std::uint64_t acknowledged = 0;  // bytes confirmed by the peer's kernel
    std::uint64_t received = 0;      // bytes from the peer

    bool operator==(const TcpProgress&) const = default;
};

// Requires Linux 4.1. Returns zeros when the socket is closed.
TcpProgress tcpProgress(int socket);

}  // namespace spherule::net

#pragma once

#include <cstdint>

namespace spherule::net {

// What really crossed the network, as the kernel counts it since the connection was made. A write that completed says
// only that the kernel's buffer had room, and one large write shows nothing of the bytes that leave meanwhile.
struct TcpProgress {
    std::uint64_t acknowledged = 0;  // bytes that the peer's machine has confirmed
    std::uint64_t received = 0;      // bytes that came from it

    bool operator==(const TcpProgress&) const = default;
};

// Linux 4.1 and newer; zeros for a socket that is closed.
TcpProgress tcpProgress(int socket);

}  // namespace spherule::net

#include "net/tcp_progress.h"

// The kernel's own header: glibc's <netinet/tcp.h> has a shorter tcp_info, and the two cannot meet in one file.
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace spherule::net {

TcpProgress tcpProgress(int socket) {
    tcp_info info{};
    socklen_t size = sizeof info;
    if (getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return {};
    return {.acknowledged = info.tcpi_bytes_acked, .received = info.tcpi_bytes_received};
}

}  // namespace spherule::net

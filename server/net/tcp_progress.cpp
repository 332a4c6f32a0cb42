#include "net/tcp_progress.h"

// The kernel's header: tcp_info of glibc's <netinet/tcp.h> is shorter. The two headers cannot be included in one file.
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

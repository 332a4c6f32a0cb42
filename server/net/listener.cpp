#include "net/listener.h"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <chrono>
#include <string>
#include <utility>

#include <boost/asio/strand.hpp>

#include "core/log.h"
#include "net/http.h"

namespace spherule::net {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

// Bytes. Limits of the kernel's send buffer and of its unsent part. With the defaults, seconds of frames would queue in
// the kernel for a slow client. The kernel doubles the first value for its bookkeeping.
constexpr int sendBuffer = 256 * 1024;
constexpr int mostUnsent = 32 * 1024;
constexpr std::chrono::milliseconds retryAfter{100};

std::string adviceOn(const error_code& error) {
    if (error == asio::error::access_denied) return "ports below 1024 need a privilege: choose one above";
    if (error == asio::error::address_in_use) return "end what listens there, or choose another port (0: any free one)";
    return "choose an address of this machine (0.0.0.0: all of them)";
}

}  // namespace

Listener::Listener(asio::io_context& io, ServerState& state) : io_(io), state_(state), acceptor_(io), retryTimer_(io) {}

Result<void> Listener::open() {
    const Options& options = state_.options;
    const std::string address = options.host + ":" + std::to_string(options.port);
    error_code error;
    const auto found =
        tcp::resolver(io_).resolve(options.host, std::to_string(options.port), tcp::resolver::passive, error);
    if (error) return fail(ErrorKind::Input, address, "cannot be listened on: " + error.message());
    const tcp::endpoint endpoint = found.begin()->endpoint();
    const bool proxied = !options.allowedNames.hosts.empty() || !options.allowedNames.origins.empty();
    if (!options.open && !requiresToken(options.credentials) && (proxied || !endpoint.address().is_loopback()))
        return fail(ErrorKind::Input, address,
                    "other machines can reach this server: require a token (--controller-token-file FILE, "
                    "--viewer-token-file FILE), or let everybody view and command (--open)");
    acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error) {
        return fail(ErrorKind::Refused, address, "cannot be listened on: " + error.message() + "; " + adviceOn(error));
    }
    port_ = acceptor_.local_endpoint().port();
    return {};
}

void Listener::run() {
    accept();
}

void Listener::close() {
    error_code ignored;
    acceptor_.close(ignored);
    retryTimer_.cancel();
}

void Listener::accept() {
    acceptor_.async_accept(asio::make_strand(io_), [self = shared_from_this()](error_code error, tcp::socket socket) {
        self->onAccept(error, std::move(socket));
    });
}

void Listener::onAccept(error_code error, tcp::socket socket) {
    if (!acceptor_.is_open()) return;
    if (error) {
        // Usually out of file descriptors: retry later, when a session may have ended.
        state_.rejectionLog.rejected(RejectReason::Accept, error.message());
        retryTimer_.expires_after(retryAfter);
        retryTimer_.async_wait([self = shared_from_this()](error_code cancelled) {
            if (!cancelled) self->accept();
        });
        return;
    }
    try {
        serve(std::move(socket));
    } catch (const std::exception&) {
        ++state_.counters.rejectedFor(RejectReason::Fault);
    }
    accept();
}

void Listener::serve(tcp::socket socket) {
    // Errors are ignored: the peer may have disconnected already.
    error_code ignored;
    const auto address = socket.remote_endpoint(ignored).address();
    if (const auto cause = state_.limiter->refuses(address, ConnectionLimiter::Clock::now())) {
        state_.rejectionLog.rejected(*cause, address.to_string());
        // Reset instead of close, so that no socket stays in TIME_WAIT for a minute.
        socket.set_option(asio::socket_base::linger(true, 0), ignored);
        socket.close(ignored);
        return;
    }
    socket.set_option(tcp::no_delay(true), ignored);
    socket.set_option(asio::socket_base::send_buffer_size(sendBuffer), ignored);
    setsockopt(socket.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &mostUnsent, sizeof mostUnsent);
    std::make_shared<HttpConnection>(Transport(boost::beast::tcp_stream(std::move(socket)), state_.tls),
                                     state_.limiter->admit(address), address.to_string(), state_)
        ->run();
}

}  // namespace spherule::net

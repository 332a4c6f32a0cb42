#include "client/client.h"

#include <utility>

#include <google/protobuf/util/json_util.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "client/url.h"
#include "net/transport.h"

namespace spherule::client {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;

namespace {

constexpr std::size_t largestMessage = std::size_t{256} << 20U;  // bytes; about 40 million spheres in one frame
constexpr std::uint16_t closedAbnormally = 1006;

}  // namespace

// Each blocking call runs the io_context over an asynchronous call, because Beast's blocking calls have no timeout.
struct Client::Connection {
    explicit Connection(net::Tls tls) : stream(beast::tcp_stream(io), std::move(tls)) {}

    asio::io_context io{1};
    websocket::stream<net::Transport, false> stream;
    beast::flat_buffer incoming{};
    std::string url{};
    Timeout timeout{};
    bool reading = false;  // a read is pending, started by an earlier receive()
    std::optional<error_code> readDone{};
    std::optional<CloseFrame> closed{};
    net::Encoding receivedAs = net::Encoding::Binary;

    // Runs until `done` has a value; returns false after `limit`.
    bool wait(const std::optional<error_code>& done, Timeout limit) {
        const auto end = std::chrono::steady_clock::now() + limit;
        io.restart();
        while (!done && io.run_one_until(end) > 0) {
        }
        return done.has_value();
    }

    template <class Start>
    error_code waitFor(Start start) {
        std::optional<error_code> done;
        start([&done](error_code error, auto&&...) { done = error; });
        if (!wait(done, timeout)) {
            beast::get_lowest_layer(stream).close();
            io.restart();
            while (!done && io.run_one() > 0) {
            }
            return asio::error::timed_out;
        }
        return *done;
    }

    // Does the TLS handshake, if there is TLS. The certificate must be valid for `host`.
    Result<void> handshake(const std::string& host) {
        auto* const secure = stream.next_layer().secure();
        if (secure == nullptr) return {};
        // Server name indication: several servers may share one address.
        SSL_set_tlsext_host_name(secure->native_handle(), host.c_str());
        secure->set_verify_callback(asio::ssl::host_name_verification(host));
        const error_code failed =
            waitFor([&](auto done) { secure->async_handshake(asio::ssl::stream_base::client, done); });
        if (!failed) return {};
        const long why = SSL_get_verify_result(secure->native_handle());
        return tl::unexpected(
            error("the TLS handshake failed: " + (why == X509_V_OK ? failed.message()
                                                                   : std::string("its certificate is refused: ") +
                                                                         X509_verify_cert_error_string(why))));
    }

    [[nodiscard]] Error error(const std::string& what) const {
        return {.kind = ErrorKind::Refused, .where = url, .message = what};
    }
};

Client::Client(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}

Client::~Client() = default;

Result<std::unique_ptr<Client>> Client::connect(const std::string& url, Timeout timeout, const std::string& subprotocol,
                                                const std::string& authorities) {
    const auto parts = parseUrl(url);
    if (!parts) return tl::unexpected(parts.error());
    net::Tls tls;
    if (parts->secure) {
        auto made = net::clientTls(authorities);
        if (!made) return tl::unexpected(made.error());
        tls = std::move(*made);
    }
    auto connection = std::make_unique<Connection>(std::move(tls));
    connection->url = url;
    connection->timeout = timeout;
    auto& stream = connection->stream;
    error_code error;
    const auto endpoints = tcp::resolver(connection->io).resolve(parts->host, parts->port, error);
    if (!error) {
        error = connection->waitFor([&](auto done) { beast::get_lowest_layer(stream).async_connect(endpoints, done); });
    }
    if (error) return tl::unexpected(connection->error("cannot be reached: " + error.message()));
    if (auto met = connection->handshake(parts->host); !met) return tl::unexpected(met.error());
    stream.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
        if (!subprotocol.empty()) request.set(http::field::sec_websocket_protocol, subprotocol);
    }));
    stream.read_message_max(largestMessage);
    websocket::response_type response;
    const std::string host = parts->host.find(':') == std::string::npos ? parts->host : "[" + parts->host + "]";
    error = connection->waitFor(
        [&](auto done) { stream.async_handshake(response, host + ":" + parts->port, parts->path, done); });
    if (error) {
        const std::string reason = response.body().empty() ? error.message() : response.body();
        return tl::unexpected(connection->error("is not a stream of spherule: HTTP " +
                                                std::to_string(response.result_int()) + ", " + reason));
    }
    return std::unique_ptr<Client>(new Client(std::move(connection)));
}

Result<void> Client::send(const v1::ClientMessage& message, net::Encoding encoding) {
    if (encoding == net::Encoding::Binary) return sendBytes(message.SerializeAsString(), encoding);
    std::string text;
    const auto status = google::protobuf::util::MessageToJsonString(message, &text);
    if (!status.ok()) return fail(ErrorKind::Input, "", "the message has no JSON form: " + status.ToString());
    return sendBytes(text, encoding);
}

Result<void> Client::sendBytes(std::string_view bytes, net::Encoding encoding) {
    auto& stream = connection_->stream;
    stream.text(encoding == net::Encoding::Text);
    const error_code error =
        connection_->waitFor([&](auto done) { stream.async_write(asio::buffer(bytes.data(), bytes.size()), done); });
    if (error) return tl::unexpected(connection_->error("the message could not be sent: " + error.message()));
    return {};
}

Result<std::optional<v1::ServerMessage>> Client::receive(Timeout timeout) {
    Connection& connection = *connection_;
    if (connection.closed) return tl::unexpected(connection.error("closed: " + connection.closed->reason));
    if (!connection.reading) {
        connection.reading = true;
        connection.readDone.reset();
        connection.stream.async_read(connection.incoming,
                                     [&connection](error_code error, std::size_t) { connection.readDone = error; });
    }
    if (!connection.wait(connection.readDone, timeout)) return std::nullopt;
    connection.reading = false;
    if (*connection.readDone) {
        const auto& closeReason = connection.stream.reason();
        const bool clean = *connection.readDone == websocket::error::closed;
        connection.closed = clean ? CloseFrame{closeReason.code, {closeReason.reason.data(), closeReason.reason.size()}}
                                  : CloseFrame{closedAbnormally, connection.readDone->message()};
        return tl::unexpected(connection.error("closed with " + std::to_string(connection.closed->code) + ": " +
                                               connection.closed->reason));
    }
    connection.receivedAs = connection.stream.got_text() ? net::Encoding::Text : net::Encoding::Binary;
    const auto bytes = connection.incoming.cdata();
    const std::string_view text(static_cast<const char*>(bytes.data()), bytes.size());
    v1::ServerMessage message;
    const bool decoded = connection.receivedAs == net::Encoding::Text
                             ? google::protobuf::util::JsonStringToMessage({text.data(), text.size()}, &message).ok()
                             : message.ParseFromArray(text.data(), static_cast<int>(text.size()));
    connection.incoming.clear();
    if (!decoded) return tl::unexpected(connection.error("sent something that is no message of spherule.v1"));
    return message;
}

net::Encoding Client::receivedAs() const {
    return connection_->receivedAs;
}

const std::optional<CloseFrame>& Client::closed() const {
    return connection_->closed;
}

void Client::close() {
    if (connection_->closed) return;
    connection_->waitFor([&](auto done) { connection_->stream.async_close(websocket::close_code::normal, done); });
}

}  // namespace spherule::client

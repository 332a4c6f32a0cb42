#include "client/fetch.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>

#include "net/transport.h"

namespace spherule::client {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using beast::error_code;

// One request as a chain of asynchronous calls; the stream's timeout covers them all.
struct Exchange {
    asio::io_context io{1};
    net::Transport stream;
    http::request<http::empty_body> request{http::verb::get, "/", 11};
    http::response<http::string_body> answer{};
    beast::flat_buffer buffer{};
    error_code error{};

    explicit Exchange(net::Tls tls) : stream(beast::tcp_stream(io), std::move(tls)) {}

    void run(const asio::ip::tcp::resolver::results_type& endpoints) {
        stream.next_layer().async_connect(endpoints, [this](error_code result, const auto&) {
            if (!failed(result)) shakeHands();
        });
        io.run();
    }

  private:
    bool failed(error_code result) {
        error = result;
        return result.failed();
    }
    void shakeHands() {
        if (auto* const secure = stream.secure())
            return secure->async_handshake(asio::ssl::stream_base::client, [this](error_code result) {
                if (!failed(result)) send();
            });
        send();
    }
    void send() {
        http::async_write(stream, request, [this](error_code result, std::size_t) {
            if (!failed(result)) receive();
        });
    }
    void receive() {
        http::async_read(stream, buffer, answer, [this](error_code result, std::size_t) { failed(result); });
    }
};

}  // namespace

Result<Fetched> fetch(const Url& url, std::chrono::milliseconds timeout) {
    net::Tls tls;
    if (url.secure) {
        auto made = net::clientTls("");
        if (!made) return tl::unexpected(made.error());
        tls = std::move(*made);
        tls->set_verify_mode(asio::ssl::verify_none);
    }
    Exchange exchange(std::move(tls));
    const std::string where = url.host + ":" + url.port;
    const auto refuse = [&](const error_code& error) {
        return fail(ErrorKind::Refused, where, "gives no answer: " + error.message());
    };
    const auto endpoints = asio::ip::tcp::resolver(exchange.io).resolve(url.host, url.port, exchange.error);
    if (exchange.error) return refuse(exchange.error);
    exchange.request.target(url.path);
    exchange.request.set(http::field::host, url.host.find(':') == std::string::npos ? url.host : "[" + url.host + "]");
    exchange.stream.next_layer().expires_after(timeout);
    exchange.run(endpoints);
    if (exchange.error) return refuse(exchange.error);
    return Fetched{.status = static_cast<int>(exchange.answer.result_int()), .body = std::move(exchange.answer.body())};
}

}  // namespace spherule::client

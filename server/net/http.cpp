#include "net/http.h"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include <boost/asio/dispatch.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "net/session.h"

namespace spherule::net {

namespace beast = boost::beast;
namespace http = beast::http;

namespace {

constexpr std::uint32_t headerLimit = 16U * 1024U;
constexpr std::uint64_t bodyLimit = 10'000;
constexpr std::chrono::seconds timeLimit{30};  // for a request, and for its answer
constexpr std::chrono::seconds goodbyeLimit{2};
constexpr std::string_view streamPath = "/ws";

std::string pathOf(std::string_view target) {
    return std::string(target.substr(0, target.find('?')));
}

bool asksForSubprotocol(const http::request<http::string_body>& request) {
    const http::token_list wanted(request[http::field::sec_websocket_protocol]);
    return std::any_of(wanted.begin(), wanted.end(), [](const auto& token) { return token == subprotocol; });
}

}  // namespace

HttpConnection::HttpConnection(beast::tcp_stream stream, Context& context)
    : context_(context), stream_(std::move(stream)) {}

void HttpConnection::run() {
    boost::asio::dispatch(stream_.get_executor(), [self = shared_from_this()] { self->read(); });
}

void HttpConnection::read() {
    parser_.emplace();
    parser_->header_limit(headerLimit);
    parser_->body_limit(bodyLimit);
    stream_.expires_after(timeLimit);
    http::async_read(stream_, incoming_, *parser_,
                     [self = shared_from_this()](ErrorCode error, std::size_t) { self->onRead(error); });
}

void HttpConnection::onRead(ErrorCode error) {
    if (error == http::error::end_of_stream) return shutdown();
    if (error) return refuseUnread(error);
    ++context_.counters.httpRequests;
    const Request request = parser_->release();
    const std::string path = pathOf({request.target().data(), request.target().size()});
    if (path == streamPath) return onUpgrade(request);
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
        return refuse(request, 405, "only GET and HEAD are answered here");
    }
    if (path.empty() || path.front() != '/') return refuse(request, 400, "the target must be a path");
    answer(request, context_.handlers.get(path, context_.counters));
}

void HttpConnection::onUpgrade(const Request& request) {
    if (!beast::websocket::is_upgrade(request)) {
        return refuse(request, 400, "this is the stream: open it as a WebSocket with subprotocol spherule.v1");
    }
    if (!asksForSubprotocol(request)) {
        ++context_.counters.handshakesRefused;
        return refuse(request, 400, "the WebSocket must ask for subprotocol spherule.v1");
    }
    if (!context_.handlers.ready()) {
        ++context_.counters.handshakesRefused;
        return refuse(request, 503, "the scene is not ready yet: see /readyz, and try again soon");
    }
    std::make_shared<Session>(std::move(stream_), context_)->run(request);
}

void HttpConnection::answer(const Request& request, HttpAnswer answer) {
    const auto send = [this](auto response) {
        const auto shared = std::make_shared<decltype(response)>(std::move(response));
        stream_.expires_after(timeLimit);
        http::async_write(stream_, *shared, [self = shared_from_this(), shared](ErrorCode error, std::size_t) {
            if (error) return;
            if (!shared->keep_alive()) return self->shutdown();
            self->read();
        });
    };
    const auto describe = [&](auto& response) {
        response.version(request.version());
        response.keep_alive(request.keep_alive());
        response.result(static_cast<unsigned>(answer.status));
        response.set(http::field::server, "spherule/" SPHERULE_VERSION);
        response.set(http::field::content_type, answer.contentType);
        if (answer.status == 405) response.set(http::field::allow, "GET, HEAD");
    };
    if (request.method() == http::verb::head) {
        http::response<http::empty_body> response;
        describe(response);
        response.content_length(answer.body.size());
        return send(std::move(response));
    }
    http::response<http::string_body> response;
    describe(response);
    response.body() = std::move(answer.body);
    response.prepare_payload();
    send(std::move(response));
}

void HttpConnection::refuse(const Request& request, int status, const std::string& text) {
    answer(request, {.status = status, .contentType = "text/plain; charset=utf-8", .body = text + "\n"});
}

// The rest of the request is still on the wire, so the connection cannot be used again.
void HttpConnection::refuseUnread(ErrorCode error) {
    if (error.category() != http::make_error_code(http::error::bad_method).category()) return;  // broken or too slow
    Request request;
    request.version(11);
    request.keep_alive(false);
    if (error == http::error::header_limit || error == http::error::buffer_overflow) {
        return refuse(request, 431, "the headers are longer than 16 KiB");
    }
    if (error == http::error::body_limit) return refuse(request, 413, "the body is longer than 10,000 bytes");
    refuse(request, 400, "not an HTTP request: " + error.message());
}

void HttpConnection::shutdown() {
    ErrorCode ignored;
    stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
    stream_.expires_after(goodbyeLimit);
    discard();
}

// A socket closed over unread bytes resets the connection, and the answer may be lost with it.
void HttpConnection::discard() {
    stream_.async_read_some(boost::asio::buffer(discarded_), [self = shared_from_this()](ErrorCode error, std::size_t) {
        if (!error) self->discard();
    });
}

}  // namespace spherule::net

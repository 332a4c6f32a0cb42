#include "net/http.h"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include <boost/asio/dispatch.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/file_body.hpp>
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
constexpr std::chrono::seconds answerLimit{30};
constexpr std::chrono::seconds goodbyeLimit{2};
constexpr std::string_view streamPath = "/ws";
constexpr std::string_view figuresPath = "/metrics";

// The page loads only files of this server, connects only to it, and must not be framed.
constexpr const char* contentPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; worker-src "
    "'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

std::string pathOf(std::string_view target) {
    return std::string(target.substr(0, target.find('?')));
}

std::string_view fieldOf(const http::request<http::string_body>& request, http::field field) {
    const auto value = request[field];
    return {value.data(), value.size()};
}

// The values of all fields of this name. Clients may spread a list over several.
std::string listOf(const http::request<http::string_body>& request, http::field field) {
    std::string list;
    const auto [begin, end] = request.equal_range(field);
    for (auto entry = begin; entry != end; ++entry) {
        if (entry != begin) list += ", ";
        list.append(entry->value().data(), entry->value().size());
    }
    return list;
}

// Token of "Authorization: Bearer TOKEN"; empty if there is none.
std::string_view bearerOf(const http::request<http::string_body>& request) {
    constexpr std::string_view scheme = "Bearer ";
    const std::string_view value = fieldOf(request, http::field::authorization);
    const bool given = beast::iequals(beast::string_view(value.data(), std::min(value.size(), scheme.size())), scheme);
    return given ? value.substr(scheme.size()) : std::string_view();
}

// Beast accepts unknown transfer encodings and then reads no body.
bool hasKnownEnd(const http::request<http::string_body>& request) {
    const auto encodings = request.count(http::field::transfer_encoding);
    return encodings == 0 || (encodings == 1 && beast::iequals(request[http::field::transfer_encoding], "chunked"));
}

bool asksForSubprotocol(const http::request<http::string_body>& request) {
    const http::token_list wanted(request[http::field::sec_websocket_protocol]);
    return std::any_of(wanted.begin(), wanted.end(), [](const auto& token) { return token == subprotocol; });
}

}  // namespace

void HttpConnection::describe(Fields& answer) {
    answer.set(http::field::server, "spherule/" SPHERULE_VERSION);
    answer.set("Content-Security-Policy", contentPolicy);
    answer.set("X-Content-Type-Options", "nosniff");
    answer.set("Referrer-Policy", "no-referrer");
    answer.set("Cross-Origin-Opener-Policy", "same-origin");
    answer.set("Cross-Origin-Resource-Policy", "same-origin");
    answer.set(http::field::cache_control, "no-cache");
}

HttpConnection::HttpConnection(Transport stream, std::unique_ptr<ConnectionLimiter::Permit> permit, std::string peer,
                               ServerState& state)
    : state_(state),
      stream_(std::move(stream)),
      permit_(std::move(permit)),
      peer_(std::move(peer)),
      delay_(stream_.get_executor()) {}

void HttpConnection::run() {
    boost::asio::dispatch(stream_.get_executor(), [self = shared_from_this()] { self->shakeHands(); });
}

void HttpConnection::shakeHands() {
    auto* const secure = stream_.secure();
    if (secure == nullptr) return read();
    tcp().expires_after(state_.options.requestTimeout);
    secure->async_handshake(boost::asio::ssl::stream_base::server, [self = shared_from_this()](ErrorCode error) {
        if (!error) return self->read();
        self->state_.rejectionLog.rejected(
            error == beast::error::timeout ? RejectReason::SlowRequest : RejectReason::Tls, self->peer_);
    });
}

void HttpConnection::read() {
    parser_.emplace();
    parser_->header_limit(headerLimit);
    parser_->body_limit(bodyLimit);
    tcp().expires_after(state_.options.requestTimeout);
    http::async_read(stream_, incoming_, *parser_,
                     [self = shared_from_this()](ErrorCode error, std::size_t) { self->onRead(error); });
}

void HttpConnection::onRead(ErrorCode error) {
    if (error == http::error::end_of_stream) return shutdown();
    if (error) return refuseUnread(error);
    ++state_.counters.httpRequests;
    Request request = parser_->release();
    if (!hasKnownEnd(request)) {
        // The end of the body is unknown, so the connection cannot be reused.
        request.keep_alive(false);
        return refuse(request, RejectReason::Malformed, 501, "the only supported transfer encoding is chunked");
    }
    const std::string path = pathOf({request.target().data(), request.target().size()});
    if (!state_.admission->isHost(fieldOf(request, http::field::host))) {
        return refuse(
            request, RejectReason::Host, 421,
            "this server does not go by the name in the Host header: use its address, or start it with --host NAME");
    }
    if (path == streamPath) return onUpgrade(request);
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
        return refuse(request, RejectReason::BadRequest, 405, "only GET and HEAD are answered here");
    }
    if (path.empty() || path.front() != '/') {
        return refuse(request, RejectReason::BadRequest, 400, "the target must be a path");
    }
    if (!mayRead(request, path)) return;
    if (path == scenePath && request.method() == http::verb::head)
        return answer(request, {.status = 200, .contentType = "application/json", .body = ""});
    if (path == scenePath) return answerDocument(request);
    if (const StaticFile* const file = state_.handlers.file(path)) return answerFile(request, *file);
    if (const auto file = state_.handlers.download(path)) return answerDownload(request, *file);
    answer(request, state_.handlers.get(path, state_.counters));
}

// The metrics, downloads and the scene need a token: the page and the health checks are public. Sends the refusal
// itself.
bool HttpConnection::mayRead(const Request& request, const std::string& path) {
    const bool isPublic = path != figuresPath && path != scenePath && !path.starts_with(downloadsPath);
    if (isPublic || state_.admission->roleOf(bearerOf(request))) return true;
    if (bearerOf(request).empty())
        refuse(request, RejectReason::NoToken, 401, "this server asks for a token: send Authorization: Bearer TOKEN");
    else
        refuseLater(request);
    return false;
}

// Delays the answer to a wrong token, to slow down guessing.
void HttpConnection::refuseLater(const Request& request) {
    tcp().expires_never();
    delay_.expires_after(state_.options.guessDelay);
    delay_.async_wait([self = shared_from_this(), request](ErrorCode) {
        self->refuse(request, RejectReason::WrongToken, 401, "this token is not known here");
    });
}

void HttpConnection::onUpgrade(const Request& request) {
    if (!beast::websocket::is_upgrade(request)) {
        return refuse(request, RejectReason::Handshake, 400,
                      "this is the stream: open it as a WebSocket with subprotocol spherule.v1");
    }
    // Only browsers send an origin. Other clients could send any origin, so a missing one is accepted.
    const std::string_view origin = fieldOf(request, http::field::origin);
    if (!origin.empty() && !state_.admission->isOrigin(origin, fieldOf(request, http::field::host))) {
        return refuse(request, RejectReason::Origin, 403,
                      "pages of this origin may not open the stream: start the server with --origin, if they should");
    }
    if (!asksForSubprotocol(request)) {
        return refuse(request, RejectReason::Subprotocol, 400, "the WebSocket must ask for subprotocol spherule.v1");
    }
    if (!state_.handlers.ready()) {
        return refuse(request, RejectReason::NotReady, 503,
                      "the scene is not ready yet: see /readyz, and try again soon");
    }
    std::make_shared<Session>(std::move(stream_), std::move(permit_), peer_, state_)->run(request);
}

void HttpConnection::answerFile(const Request& request, const StaticFile& file) {
    const bool compressed = acceptsGzip(listOf(request, http::field::accept_encoding));
    const StaticFile::Form& form = compressed ? file.gzip : file.plain;
    Fields more;
    more.set(http::field::etag, form.tag);
    more.set(http::field::vary, "Accept-Encoding");
    if (isKnown(listOf(request, http::field::if_none_match), form.tag))
        return answer(request, {.status = 304, .contentType = "", .body = ""}, more);
    if (compressed) more.set(http::field::content_encoding, "gzip");
    answer(request, {.status = 200, .contentType = file.contentType, .body = std::string(form.bytes)}, more);
}

// A response whose body is read from the disk, part by part.
struct HttpConnection::Download {
    http::response<http::file_body> response;
    std::optional<http::response_serializer<http::file_body>> serializer{};  // made when the file is open
};

void HttpConnection::answerDownload(const Request& request, const std::string& path) {
    const std::string name = path.substr(path.rfind('/') + 1);
    const auto download = std::make_shared<Download>();
    auto& response = download->response;
    ErrorCode error;
    response.body().open(path.c_str(), beast::file_mode::scan, error);
    if (error) {
        const HttpAnswer gone{404, "text/plain; charset=utf-8", "This recording is not on the disk any more.\n"};
        return answer(request, gone);
    }
    response.version(request.version());
    response.keep_alive(request.keep_alive());
    describe(response);
    response.set(http::field::content_type, "application/octet-stream");
    response.set(http::field::content_disposition, "attachment; filename=\"" + name + "\"");
    response.prepare_payload();
    download->serializer.emplace(response).split(request.method() == http::verb::head);
    send(download);
}

// The deadline holds for a part, because a large file on a slow line takes long.
void HttpConnection::send(const std::shared_ptr<Download>& download) {
    tcp().expires_after(state_.options.progressTimeout);
    const auto sent = [self = shared_from_this(), download](ErrorCode error, std::size_t) {
        if (error) return;
        auto& serializer = *download->serializer;
        const bool ends = serializer.split() ? serializer.is_header_done() : serializer.is_done();
        if (!ends) return self->send(download);
        if (!download->response.keep_alive()) return self->shutdown();
        self->read();
    };
    http::async_write_some(stream_, *download->serializer, sent);
}

// `more`: further headers.
void HttpConnection::answer(const Request& request, HttpAnswer answer, const Fields& more) {
    const auto send = [this](auto response) {
        const auto shared = std::make_shared<decltype(response)>(std::move(response));
        tcp().expires_after(answerLimit);
        http::async_write(stream_, *shared, [self = shared_from_this(), shared](ErrorCode error, std::size_t) {
            if (error) return;
            if (!shared->keep_alive()) return self->shutdown();
            self->read();
        });
    };
    const auto begin = [&](auto& response) {
        response.version(request.version());
        response.keep_alive(request.keep_alive());
        response.result(static_cast<unsigned>(answer.status));
        describe(response);
        if (!answer.contentType.empty()) response.set(http::field::content_type, answer.contentType);
        for (const auto& field : more) response.set(field.name(), field.value());
        if (answer.status == 405) response.set(http::field::allow, "GET, HEAD");
        if (answer.status == 401) response.set(http::field::www_authenticate, "Bearer");
        if (answer.status == 503) response.set(http::field::retry_after, "5");
    };
    if (request.method() == http::verb::head || answer.status == 304) {
        http::response<http::empty_body> response;
        begin(response);
        if (answer.status != 304) response.content_length(answer.body.size());
        return send(std::move(response));
    }
    http::response<http::string_body> response;
    begin(response);
    response.body() = std::move(answer.body);
    response.prepare_payload();
    send(std::move(response));
}

void HttpConnection::refuse(const Request& request, RejectReason cause, int status, const std::string& text) {
    state_.rejectionLog.rejected(cause, peer_);
    answer(request, {.status = status, .contentType = "text/plain; charset=utf-8", .body = text + "\n"});
}

// The rest of the request has not been read, so the connection cannot be reused.
void HttpConnection::refuseUnread(ErrorCode error) {
    if (error == beast::error::timeout && (parser_->got_some() || incoming_.size() > 0))
        state_.rejectionLog.rejected(RejectReason::SlowRequest, peer_);
    if (error.category() != http::make_error_code(http::error::bad_method).category())
        return;  // connection broken, or request too slow
    Request request;
    request.version(11);
    request.keep_alive(false);
    if (error == http::error::header_limit || error == http::error::buffer_overflow) {
        return refuse(request, RejectReason::LongHeader, 431, "the headers are longer than 16 KiB");
    }
    if (error == http::error::body_limit) {
        return refuse(request, RejectReason::LongBody, 413, "the body is longer than 10,000 bytes");
    }
    refuse(request, RejectReason::Malformed, 400, "not an HTTP request: " + error.message());
}

void HttpConnection::shutdown() {
    tcp().expires_after(goodbyeLimit);
    // The TLS shutdown waits for the peer's shutdown and reads the remaining data.
    if (auto* const secure = stream_.secure()) return secure->async_shutdown([self = shared_from_this()](ErrorCode) {});
    ErrorCode ignored;
    tcp().socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
    discard();
}

// Reads the remaining data: closing a socket with unread data resets the connection, and the answer may be lost.
void HttpConnection::discard() {
    tcp().async_read_some(boost::asio::buffer(discarded_), [self = shared_from_this()](ErrorCode error, std::size_t) {
        if (!error) self->discard();
    });
}

}  // namespace spherule::net

#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include "net/server_state.h"
#include "net/transport.h"

namespace spherule::net {

// One HTTP/1.1 connection. Answers GET and HEAD through the Handlers, and hands the connection over to a Session when
// the client upgrades at /ws. Refuses requests with a foreign Host header or origin. Used on the strand of its stream.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
  public:
    HttpConnection(Transport stream, std::unique_ptr<ConnectionLimiter::Permit> permit, std::string peer,
                   ServerState& state);

    void run();

  private:
    using ErrorCode = boost::beast::error_code;
    using Fields = boost::beast::http::fields;
    using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;
    using Request = Parser::value_type;

    static void describe(Fields& answer);  // adds the headers of every answer
    void shakeHands();
    void read();
    void onRead(ErrorCode error);
    void onUpgrade(const Request& request);
    [[nodiscard]] bool mayRead(const Request& request, const std::string& path);
    void answerFile(const Request& request, const StaticFile& file);
    void answerDownload(const Request& request, const std::string& path);
    struct Download;
    void send(const std::shared_ptr<Download>& download);
    // A response whose body is made while it is sent: in http_document.cpp.
    void answerDocument(const Request& request);
    struct Sending;
    void sendPart(const std::shared_ptr<Sending>& sending);
    void endDocument(const std::shared_ptr<Sending>& sending);
    void answer(const Request& request, HttpAnswer answer, const Fields& more = {});
    void refuse(const Request& request, RejectReason cause, int status, const std::string& text);
    void refuseLater(const Request& request);
    void refuseUnread(ErrorCode error);
    void shutdown();
    void discard();
    boost::beast::tcp_stream& tcp() { return stream_.next_layer(); }

    ServerState& state_;
    Transport stream_;
    std::unique_ptr<ConnectionLimiter::Permit> permit_;
    std::string peer_;  // address
    boost::asio::steady_timer delay_;
    // Bounds the bytes that Beast's parser buffers, such as an endless chunk extension.
    boost::beast::flat_buffer incoming_{std::size_t{64} * 1024};
    std::optional<Parser> parser_;
    std::array<char, 4096> discarded_{};
};

}  // namespace spherule::net

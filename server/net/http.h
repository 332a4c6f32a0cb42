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

// One connection that speaks HTTP/1.1: answers GET and HEAD through Handlers.get until the client leaves or asks for
// the stream at /ws, which makes it a Session. Whoever does not mean this server, or has no business at the stream, is
// refused. Everything happens on the strand of its stream.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
  public:
    HttpConnection(Transport stream, std::unique_ptr<ConnectionLimiter::Permit> permit, std::string peer,
                   ServerState& state);

    void run();

  private:
    using ErrorCode = boost::beast::error_code;
    using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;
    using Request = Parser::value_type;

    void shakeHands();
    void read();
    void onRead(ErrorCode error);
    void onUpgrade(const Request& request);
    [[nodiscard]] bool mayRead(const Request& request, const std::string& path);
    void answer(const Request& request, HttpAnswer answer);
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
    // What Beast's parser keeps back, such as an extension of a chunk that has no end, is bounded by nothing else.
    boost::beast::flat_buffer incoming_{std::size_t{64} * 1024};
    std::optional<Parser> parser_;
    std::array<char, 4096> discarded_{};
};

}  // namespace spherule::net

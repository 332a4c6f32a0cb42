#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include "net/context.h"

namespace spherule::net {

// One connection that speaks HTTP/1.1: answers GET and HEAD through Handlers.get until the client leaves or asks for
// the stream at /ws, which makes it a Session. Everything happens on the strand of its stream.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
  public:
    HttpConnection(boost::beast::tcp_stream stream, Context& context);

    void run();

  private:
    using ErrorCode = boost::beast::error_code;
    using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;
    using Request = Parser::value_type;

    void read();
    void onRead(ErrorCode error);
    void onUpgrade(const Request& request);
    void answer(const Request& request, HttpAnswer answer);
    void refuse(const Request& request, int status, const std::string& text);
    void refuseUnread(ErrorCode error);
    void shutdown();
    void discard();

    Context& context_;
    boost::beast::tcp_stream stream_;
    boost::beast::flat_buffer incoming_;
    std::optional<Parser> parser_;
    std::array<char, 4096> discarded_{};
};

}  // namespace spherule::net

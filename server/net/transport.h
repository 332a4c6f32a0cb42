#pragma once

#include <memory>
#include <utility>
#include <variant>

#include <boost/asio/async_result.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/teardown.hpp>

#include "net/tls.h"

namespace spherule::net {

// A TCP stream with or without TLS. Meets Beast's requirements of AsyncStream. Used on its executor.
class Transport {
    using Plain = boost::beast::tcp_stream;
    using Secure = boost::beast::ssl_stream<boost::beast::tcp_stream>;
    using ErrorCode = boost::beast::error_code;

  public:
    using executor_type = Plain::executor_type;
    using next_layer_type = Plain;

    // `tls` nullptr: no encryption.
    Transport(Plain stream, Tls tls) : tls_(std::move(tls)), layer_(over(std::move(stream), tls_)) {}

    executor_type get_executor() { return next_layer().get_executor(); }
    next_layer_type& next_layer() {
        if (auto* secure = std::get_if<Secure>(&layer_)) return secure->next_layer();
        return std::get<Plain>(layer_);
    }
    const next_layer_type& next_layer() const { return const_cast<Transport*>(this)->next_layer(); }

    // nullptr if there is no TLS.
    Secure* secure() { return std::get_if<Secure>(&layer_); }

    template <class Buffers, class Token>
    auto async_read_some(const Buffers& buffers, Token&& token) {
        return boost::asio::async_initiate<Token, void(ErrorCode, std::size_t)>(
            [this](auto handler, const auto& to) {
                std::visit([&](auto& layer) { layer.async_read_some(to, std::move(handler)); }, layer_);
            },
            token, buffers);
    }

    template <class Buffers, class Token>
    auto async_write_some(const Buffers& buffers, Token&& token) {
        return boost::asio::async_initiate<Token, void(ErrorCode, std::size_t)>(
            [this](auto handler, const auto& from) {
                std::visit([&](auto& layer) { layer.async_write_some(from, std::move(handler)); }, layer_);
            },
            token, buffers);
    }

    // Called by Beast's WebSocket after the closing handshake.
    template <class Handler>
    friend void async_teardown(boost::beast::role_type role, Transport& transport, Handler&& handler) {
        std::visit(
            [&](auto& layer) {
                using boost::beast::websocket::async_teardown;
                async_teardown(role, layer, std::forward<Handler>(handler));
            },
            transport.layer_);
    }

  private:
    using Layer = std::variant<Plain, Secure>;

    static Layer over(Plain stream, const Tls& tls) {
        if (!tls) return Layer(std::in_place_type<Plain>, std::move(stream));
        return Layer(std::in_place_type<Secure>, std::move(stream), *tls);
    }

    Tls tls_;  // must outlive the stream, also when newer connections have another context
    Layer layer_;
};

}  // namespace spherule::net

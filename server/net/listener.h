#pragma once

#include <memory>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "core/result.h"
#include "net/server_state.h"

namespace spherule::net {

// Accepts connections and gives each its own strand. Used on the io thread, unless noted.
class Listener : public std::enable_shared_from_this<Listener> {
  public:
    Listener(boost::asio::io_context& io, ServerState& state);

    // Binds the address. Call before the io thread runs. Errors: Input for an unusable address, or one that is
    // reachable from outside without tokens or --open; Refused if it cannot be bound.
    Result<void> open();
    void run();
    void close();

    // Any thread, after open().
    [[nodiscard]] std::uint16_t port() const { return port_; }

  private:
    void accept();
    void onAccept(boost::system::error_code error, boost::asio::ip::tcp::socket socket);
    void serve(boost::asio::ip::tcp::socket socket);

    boost::asio::io_context& io_;
    ServerState& state_;
    boost::asio::ip::tcp::acceptor acceptor_;
    boost::asio::steady_timer retryTimer_;
    std::uint16_t port_ = 0;
};

}  // namespace spherule::net

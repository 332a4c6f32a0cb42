#pragma once

#include <memory>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "core/result.h"
#include "net/server_state.h"

namespace spherule::net {

// Accepts connections, each with its own strand. On the io thread, except where said.
class Listener : public std::enable_shared_from_this<Listener> {
  public:
    Listener(boost::asio::io_context& io, ServerState& state);

    // Before the io thread runs. An address that cannot be bound is an error.
    Result<void> open();
    void run();
    void close();

    // Any thread, once open.
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

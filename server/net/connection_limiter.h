#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>

#include <boost/asio/ip/address.hpp>

#include "net/reject_reason.h"
#include "net/token_bucket.h"

namespace spherule::net {

// 0: no limit.
struct ConnectionLimits {
    std::size_t sessions = 256;
    std::size_t sessionsPerAddress = 64;
    double connectionsPerSecond = 50;  // per address, average and burst
};

// Limits connections and sessions, in all and per address. An address is an IPv4 address or the 64-bit network prefix
// of an IPv6 address. Beyond the sessions, 256 connections (32 per address) may be open for HTTP requests and
// handshakes. Used on the io thread.
class ConnectionLimiter : public std::enable_shared_from_this<ConnectionLimiter> {
  public:
    using Clock = TokenBucket::Clock;
    using Address = boost::asio::ip::address;

    // Counts one connection while it exists.
    class Permit {
      public:
        Permit(std::shared_ptr<ConnectionLimiter> limiter, const Address& address);
        ~Permit();
        Permit(const Permit&) = delete;
        Permit& operator=(const Permit&) = delete;

        // Counts the connection as a session. Returns the reason when the limit of sessions is reached.
        std::optional<RejectReason> openSession();

      private:
        std::shared_ptr<ConnectionLimiter> limiter_;
        Address address_;
        bool session_ = false;
    };

    explicit ConnectionLimiter(const ConnectionLimits& limits) : limits_(limits) {}

    // Returns the reason when a new connection from `address` exceeds a limit, else nullopt.
    std::optional<RejectReason> refuses(const Address& address, Clock::time_point now);
    // Call after refuses() has returned nullopt.
    std::unique_ptr<Permit> admit(const Address& address);

    // Number of addresses with a state.
    [[nodiscard]] std::size_t known() const { return addresses_.size(); }

  private:
    struct AddressState {
        std::size_t connections = 0;
        std::size_t sessions = 0;
        TokenBucket rate;
    };

    void removeIdle(Clock::time_point now);

    ConnectionLimits limits_;
    std::map<Address, AddressState> addresses_;
    std::size_t connections_ = 0;
    std::size_t sessions_ = 0;
    std::size_t sweepAt_ = 64;
};

}  // namespace spherule::net

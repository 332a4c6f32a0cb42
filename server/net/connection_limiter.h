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

// How much one server, and one address, may ask for. 0: no limit.
struct ConnectionLimits {
    std::size_t sessions = 256;
    std::size_t sessionsPerAddress = 64;
    double connectionsPerSecond = 50;  // of one address; as many at once
};

// Who is connected, by address: an IPv4 address, or the 64 bits of an IPv6 address that name a network. Beside
// sessions, there may be some connections more, for pages, handshakes and those of whom it is not known yet whether
// they may come in. On the io thread.
class ConnectionLimiter : public std::enable_shared_from_this<ConnectionLimiter> {
  public:
    using Clock = TokenBucket::Clock;
    using Address = boost::asio::ip::address;

    // One connection, for as long as it lives.
    class Permit {
      public:
        Permit(std::shared_ptr<ConnectionLimiter> limiter, const Address& address);
        ~Permit();
        Permit(const Permit&) = delete;
        Permit& operator=(const Permit&) = delete;

        // It becomes a session, unless there are too many.
        std::optional<RejectReason> openSession();

      private:
        std::shared_ptr<ConnectionLimiter> limiter_;
        Address address_;
        bool session_ = false;
    };

    explicit ConnectionLimiter(const ConnectionLimits& limits) : limits_(limits) {}

    // Whether a connection from there is one too many.
    std::optional<RejectReason> refuses(const Address& address, Clock::time_point now);
    std::unique_ptr<Permit> admit(const Address& address);

    // Addresses that are remembered.
    [[nodiscard]] std::size_t known() const { return addresses_.size(); }

  private:
    struct AddressState {
        std::size_t connections = 0;
        std::size_t sessions = 0;
        TokenBucket rate;
    };

    void forget(Clock::time_point now);

    ConnectionLimits limits_;
    std::map<Address, AddressState> addresses_;
    std::size_t connections_ = 0;
    std::size_t sessions_ = 0;
    std::size_t sweepAt_ = 64;
};

}  // namespace spherule::net

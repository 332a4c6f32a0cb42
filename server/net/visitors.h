#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>

#include <boost/asio/ip/address.hpp>

#include "net/rejection.h"
#include "net/token_bucket.h"

namespace spherule::net {

// How much one server, and one address, may ask for. 0: no limit.
struct VisitorLimits {
    std::size_t sessions = 256;
    std::size_t sessionsPerAddress = 64;
    double connectionsPerSecond = 50;  // of one address; as many at once
};

// Who is connected, by address: an IPv4 address, or the 64 bits of an IPv6 address that name a network. Beside
// sessions, there may be some connections more, for pages, handshakes and those of whom it is not known yet whether
// they may come in. On the io thread.
class Visitors : public std::enable_shared_from_this<Visitors> {
  public:
    using Clock = TokenBucket::Clock;
    using Address = boost::asio::ip::address;

    // One connection, for as long as it lives.
    class Visit {
      public:
        Visit(std::shared_ptr<Visitors> visitors, const Address& place);
        ~Visit();
        Visit(const Visit&) = delete;
        Visit& operator=(const Visit&) = delete;

        // It becomes a session, unless there are too many.
        std::optional<Rejection> openSession();

      private:
        std::shared_ptr<Visitors> visitors_;
        Address place_;
        bool session_ = false;
    };

    explicit Visitors(const VisitorLimits& limits) : limits_(limits) {}

    // Whether a connection from there is one too many.
    std::optional<Rejection> refuses(const Address& address, Clock::time_point now);
    std::unique_ptr<Visit> admit(const Address& address);

    // Addresses that are remembered.
    [[nodiscard]] std::size_t known() const { return places_.size(); }

  private:
    struct Place {
        std::size_t connections = 0;
        std::size_t sessions = 0;
        TokenBucket rate;
    };

    void forget(Clock::time_point now);

    VisitorLimits limits_;
    std::map<Address, Place> places_;
    std::size_t connections_ = 0;
    std::size_t sessions_ = 0;
    std::size_t sweepAt_ = 64;
};

}  // namespace spherule::net

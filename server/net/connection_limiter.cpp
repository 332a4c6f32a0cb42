#include "net/connection_limiter.h"

#include <algorithm>
#include <utility>

namespace spherule::net {

namespace {

// Connections that are not sessions: HTTP requests and handshakes.
constexpr std::size_t moreConnections = 256;
constexpr std::size_t moreConnectionsPerAddress = 32;
constexpr std::size_t fewAddresses = 64;

using Address = ConnectionLimiter::Address;

// A host with one IPv6 address usually has the 2^64 addresses of its network.
Address addressKey(const Address& address) {
    if (!address.is_v6()) return address;
    const auto v6 = address.to_v6();
    if (v6.is_v4_mapped()) return boost::asio::ip::make_address_v4(boost::asio::ip::v4_mapped, v6);
    auto bytes = v6.to_bytes();
    std::fill(bytes.begin() + 8, bytes.end(), static_cast<unsigned char>(0));
    return boost::asio::ip::address_v6(bytes);
}

// `limit` 0: no limit. `most`: the count at which the limit is reached.
bool reached(std::size_t limit, std::size_t most, std::size_t count) {
    return limit > 0 && count >= most;
}

}  // namespace

ConnectionLimiter::Permit::Permit(std::shared_ptr<ConnectionLimiter> limiter, const Address& address)
    : limiter_(std::move(limiter)), address_(address) {
    ++limiter_->addresses_.at(address_).connections;
    ++limiter_->connections_;
}

ConnectionLimiter::Permit::~Permit() {
    AddressState& state = limiter_->addresses_.at(address_);
    --state.connections;
    --limiter_->connections_;
    if (!session_) return;
    --state.sessions;
    --limiter_->sessions_;
}

std::optional<RejectReason> ConnectionLimiter::Permit::openSession() {
    AddressState& state = limiter_->addresses_.at(address_);
    const ConnectionLimits& limits = limiter_->limits_;
    if (reached(limits.sessions, limits.sessions, limiter_->sessions_)) return RejectReason::Sessions;
    if (reached(limits.sessionsPerAddress, limits.sessionsPerAddress, state.sessions))
        return RejectReason::SessionsPerAddress;
    session_ = true;
    ++state.sessions;
    ++limiter_->sessions_;
    return std::nullopt;
}

std::optional<RejectReason> ConnectionLimiter::refuses(const Address& address, Clock::time_point now) {
    removeIdle(now);
    const auto [found, fresh] = addresses_.try_emplace(
        addressKey(address), AddressState{.rate = TokenBucket(limits_.connectionsPerSecond, now)});
    AddressState& state = found->second;
    if (!state.rate.take(now)) return RejectReason::ConnectionRate;
    if (reached(limits_.sessions, moreConnections, connections_ - sessions_) ||
        reached(limits_.sessionsPerAddress, moreConnectionsPerAddress, state.connections - state.sessions))
        return RejectReason::Connections;
    return std::nullopt;
}

std::unique_ptr<ConnectionLimiter::Permit> ConnectionLimiter::admit(const Address& address) {
    return std::make_unique<Permit>(shared_from_this(), addressKey(address));
}

// Removes addresses without connections whose rate limit has recovered. Runs when the number of addresses has doubled
// since the last run, so that the cost per connection is constant.
void ConnectionLimiter::removeIdle(Clock::time_point now) {
    if (addresses_.size() < sweepAt_) return;
    std::erase_if(addresses_,
                  [now](auto& entry) { return entry.second.connections == 0 && entry.second.rate.full(now); });
    sweepAt_ = std::max(fewAddresses, 2 * addresses_.size());
}

}  // namespace spherule::net

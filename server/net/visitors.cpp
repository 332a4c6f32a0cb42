#include "net/visitors.h"

#include <algorithm>
#include <utility>

namespace spherule::net {

namespace {

// Beside sessions: those that load the page, ask for metrics, or are about to become sessions.
constexpr std::size_t moreConnections = 256;
constexpr std::size_t moreConnectionsPerAddress = 32;
constexpr std::size_t fewPlaces = 64;

using Address = Visitors::Address;

// Whoever has an IPv6 address has 2^64 of them.
Address placeOf(const Address& address) {
    if (!address.is_v6()) return address;
    const auto v6 = address.to_v6();
    if (v6.is_v4_mapped()) return boost::asio::ip::make_address_v4(boost::asio::ip::v4_mapped, v6);
    auto bytes = v6.to_bytes();
    std::fill(bytes.begin() + 8, bytes.end(), static_cast<unsigned char>(0));
    return boost::asio::ip::address_v6(bytes);
}

// Without a limit of sessions, there is none of what may become one.
bool reached(std::size_t limit, std::size_t most, std::size_t count) {
    return limit > 0 && count >= most;
}

}  // namespace

Visitors::Visit::Visit(std::shared_ptr<Visitors> visitors, const Address& place)
    : visitors_(std::move(visitors)), place_(place) {
    ++visitors_->places_.at(place_).connections;
    ++visitors_->connections_;
}

Visitors::Visit::~Visit() {
    Place& place = visitors_->places_.at(place_);
    --place.connections;
    --visitors_->connections_;
    if (!session_) return;
    --place.sessions;
    --visitors_->sessions_;
}

std::optional<Rejection> Visitors::Visit::openSession() {
    Place& place = visitors_->places_.at(place_);
    const VisitorLimits& limits = visitors_->limits_;
    if (reached(limits.sessions, limits.sessions, visitors_->sessions_)) return Rejection::Sessions;
    if (reached(limits.sessionsPerAddress, limits.sessionsPerAddress, place.sessions))
        return Rejection::SessionsPerAddress;
    session_ = true;
    ++place.sessions;
    ++visitors_->sessions_;
    return std::nullopt;
}

std::optional<Rejection> Visitors::refuses(const Address& address, Clock::time_point now) {
    forget(now);
    const auto [found, fresh] =
        places_.try_emplace(placeOf(address), Place{.rate = TokenBucket(limits_.connectionsPerSecond, now)});
    Place& place = found->second;
    if (!place.rate.take(now)) return Rejection::ConnectionRate;
    if (reached(limits_.sessions, moreConnections, connections_ - sessions_) ||
        reached(limits_.sessionsPerAddress, moreConnectionsPerAddress, place.connections - place.sessions))
        return Rejection::Connections;
    return std::nullopt;
}

std::unique_ptr<Visitors::Visit> Visitors::admit(const Address& address) {
    return std::make_unique<Visit>(shared_from_this(), placeOf(address));
}

// Whoever has left, and has been quiet for long enough, is as good as new. Swept when there are twice as many as were
// left by the last time, so that it costs little.
void Visitors::forget(Clock::time_point now) {
    if (places_.size() < sweepAt_) return;
    std::erase_if(places_, [now](auto& entry) { return entry.second.connections == 0 && entry.second.rate.full(now); });
    sweepAt_ = std::max(fewPlaces, 2 * places_.size());
}

}  // namespace spherule::net

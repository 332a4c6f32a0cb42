#include "net/pace.h"

#include <algorithm>

#include <spdlog/fmt/fmt.h>

namespace spherule::net {

namespace {

using namespace std::chrono_literals;

constexpr std::size_t severalLosses = 3;
constexpr auto together = 3s;
constexpr auto leastPatience = 10s;
constexpr auto mostPatience = 160s;
constexpr auto tooEarly = 5s;            // for a step down after one up
constexpr std::uint32_t watchable = 10;  // frames per second, below which precision goes first
constexpr double drawn = 0.6;            // of the frames: with fewer pictures, frames are sent in vain
constexpr double busy = 0.6;             // of the time between frames, with decoding one
constexpr int slowFor = 30;              // acks

std::optional<std::uint32_t> below(std::uint32_t rate) {
    const auto found = std::ranges::lower_bound(codec::rates, rate);
    if (found == codec::rates.begin()) return std::nullopt;
    return *(found - 1);
}

// Nothing where there is no less.
std::optional<codec::Rendition> lessThan(const codec::Rendition& rendition) {
    const auto rate = below(rendition.rate);
    if (rate && *rate >= watchable) return codec::Rendition{rendition.tier, *rate};
    if (rendition.tier != v1::ECO)
        return codec::Rendition{rendition.tier == v1::FINE ? v1::NORMAL : v1::ECO, rendition.rate};
    if (rate) return codec::Rendition{rendition.tier, *rate};
    return std::nullopt;
}

}  // namespace

bool Pace::want(const codec::Rendition& rendition, bool fixed, Clock::time_point now) {
    if (rendition == wanted_ && fixed == fixed_) return false;
    wanted_ = rendition;
    rendition_ = rendition;
    fixed_ = fixed;
    losses_.clear();
    left_.clear();
    quietSince_ = now;
    patience_ = leastPatience;
    slowAcks_ = 0;
    return true;
}

bool Pace::stepDown(Clock::time_point now) {
    const auto less = lessThan(rendition_);
    if (fixed_ || !less) return false;
    if (now - steppedUp_ < tooEarly) patience_ = std::min<std::chrono::seconds>(2 * patience_, mostPatience);
    left_.push_back(rendition_);
    rendition_ = *less;
    losses_.clear();
    slowAcks_ = 0;
    quietSince_ = now;
    return true;
}

bool Pace::stepUp(Clock::time_point now) {
    if (left_.empty() || now - quietSince_ < patience_) return false;
    rendition_ = left_.back();
    left_.pop_back();
    quietSince_ = now;
    steppedUp_ = now;
    return true;
}

std::optional<std::string> Pace::lost(Clock::time_point now) {
    losses_.push_back(now);
    while (losses_.size() > severalLosses || now - losses_.front() > together) losses_.pop_front();
    quietSince_ = now;
    if (losses_.size() < severalLosses || !stepDown(now)) return std::nullopt;
    return fmt::format("{} frames in {} s were more than the connection or the client takes", severalLosses,
                       std::chrono::seconds(together).count());
}

std::optional<std::string> Pace::acked(double drawRate, double decodeMs, Clock::time_point now) {
    const bool drawsLess = drawRate > 0 && drawRate < drawn * rendition_.rate;
    const bool decodesLong = decodeMs * rendition_.rate > busy * 1000;
    slowAcks_ = drawsLess || decodesLong ? slowAcks_ + 1 : 0;
    const auto less = lessThan(rendition_);
    const bool fewer = less && less->rate < rendition_.rate;  // less precision would not help
    if (slowAcks_ >= slowFor && fewer && stepDown(now))
        return drawsLess ? fmt::format("only {:.0f} pictures per second are drawn", drawRate)
                         : fmt::format("a frame takes {:.0f} ms to decode", decodeMs);
    return passed(now);
}

std::optional<std::string> Pace::passed(Clock::time_point now) {
    if (stepUp(now)) return "the client has kept up for a while";
    return std::nullopt;
}

}  // namespace spherule::net

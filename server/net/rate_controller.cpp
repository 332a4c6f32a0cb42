#include "net/rate_controller.h"

#include <algorithm>

#include <spdlog/fmt/fmt.h>

namespace spherule::net {

namespace {

using namespace std::chrono_literals;

constexpr std::size_t lossesPerStep = 3;  // within lossWindow
constexpr auto lossWindow = 3s;
constexpr auto minPatience = 10s;
constexpr auto maxPatience = 160s;
constexpr auto minTimeAfterStepUp = 5s;      // an earlier step down doubles the patience
constexpr std::uint32_t minSmoothRate = 10;  // frames per second; below, precision is reduced before rate
constexpr double minDrawnShare = 0.6;        // pictures per frame sent; below, frames are wasted
constexpr double maxDecodeShare = 0.6;       // of the time between two frames
constexpr int slowAcksPerStep = 30;          // consecutive acks

// nullopt if `rate` is the lowest.
std::optional<std::uint32_t> below(std::uint32_t rate) {
    const auto found = std::ranges::lower_bound(codec::rates, rate);
    if (found == codec::rates.begin()) return std::nullopt;
    return *(found - 1);
}

// nullopt if there is no lower rendition.
std::optional<codec::Rendition> nextLower(const codec::Rendition& rendition) {
    codec::Rendition lower = rendition;
    const auto rate = below(rendition.rate);
    if (rate && (*rate >= minSmoothRate || rendition.tier == v1::ECO))
        lower.rate = *rate;
    else if (rendition.tier != v1::ECO)
        lower.tier = rendition.tier == v1::FINE ? v1::NORMAL : v1::ECO;
    else
        return std::nullopt;
    return lower;
}

}  // namespace

bool RateController::setTarget(const codec::Rendition& rendition, bool fixed, Clock::time_point now) {
    if (rendition == target_ && fixed == fixed_) return false;
    target_ = rendition;
    rendition_ = rendition;
    fixed_ = fixed;
    losses_.clear();
    higher_.clear();
    quietSince_ = now;
    patience_ = minPatience;
    slowAcks_ = 0;
    return true;
}

bool RateController::stepDown(Clock::time_point now) {
    const auto less = nextLower(rendition_);
    if (fixed_ || !less) return false;
    if (now - steppedUp_ < minTimeAfterStepUp) patience_ = std::min<std::chrono::seconds>(2 * patience_, maxPatience);
    higher_.push_back(rendition_);
    rendition_ = *less;
    losses_.clear();
    slowAcks_ = 0;
    quietSince_ = now;
    return true;
}

bool RateController::stepUp(Clock::time_point now) {
    if (higher_.empty() || now - quietSince_ < patience_) return false;
    rendition_ = higher_.back();
    higher_.pop_back();
    quietSince_ = now;
    steppedUp_ = now;
    return true;
}

std::optional<std::string> RateController::onLoss(Clock::time_point now) {
    losses_.push_back(now);
    while (losses_.size() > lossesPerStep || now - losses_.front() > lossWindow) losses_.pop_front();
    quietSince_ = now;
    if (losses_.size() < lossesPerStep || !stepDown(now)) return std::nullopt;
    return fmt::format("{} frames in {} s were more than the connection or the client takes", lossesPerStep,
                       std::chrono::seconds(lossWindow).count());
}

std::optional<std::string> RateController::onAck(double drawRate, double decodeMs, Clock::time_point now) {
    const bool drawsLess = drawRate > 0 && drawRate < minDrawnShare * rendition_.rate;
    const bool decodesLong = decodeMs * rendition_.rate > maxDecodeShare * 1000;
    slowAcks_ = drawsLess || decodesLong ? slowAcks_ + 1 : 0;
    const auto less = nextLower(rendition_);
    const bool fewer = less && less->rate < rendition_.rate;  // lower precision would not help
    if (slowAcks_ >= slowAcksPerStep && fewer && stepDown(now))
        return drawsLess ? fmt::format("only {:.0f} pictures per second are drawn", drawRate)
                         : fmt::format("a frame takes {:.0f} ms to decode", decodeMs);
    return onTick(now);
}

std::optional<std::string> RateController::onTick(Clock::time_point now) {
    if (stepUp(now)) return "the client has kept up for a while";
    return std::nullopt;
}

}  // namespace spherule::net

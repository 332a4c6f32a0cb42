#include "net/rejection_log.h"

#include "core/log.h"

namespace spherule::net {

namespace {

void report(Throttle& throttle, std::string_view event, std::string_view message, std::string_view cause,
            const std::string& peer) {
    const auto suppressed = throttle.pass(Throttle::Clock::now());
    if (!suppressed) return;
    logEvent(spdlog::level::info, event, message,
             {{"cause", std::string(cause)}, {"from", peer}, {"more", std::to_string(*suppressed)}});
}

}  // namespace

void RejectionLog::rejected(RejectReason cause, const std::string& peer) {
    ++counters_.rejectedFor(cause);
    report(throttles_[static_cast<std::size_t>(cause)], "rejected", "turned away", nameOf(cause), peer);
}

void RejectionLog::ended(CloseCause cause, const std::string& peer) {
    ++counters_.closedBy(cause);
    if (cause == CloseCause::Left || cause == CloseCause::Drained) return;
    const auto index = static_cast<std::size_t>(cause);
    report(endThrottles_[index], "session_ended", "a session was ended", closeCauseNames[index], peer);
}

}  // namespace spherule::net

#include "net/rejection_log.h"

#include "core/log.h"

namespace spherule::net {

namespace {

void tell(Throttle& throttle, std::string_view event, std::string_view message, std::string_view cause,
          const std::string& who) {
    const auto more = throttle.pass(Throttle::Clock::now());
    if (!more) return;
    logEvent(spdlog::level::info, event, message,
             {{"cause", std::string(cause)}, {"from", who}, {"more", std::to_string(*more)}});
}

}  // namespace

void RejectionLog::rejected(RejectReason cause, const std::string& who) {
    ++counters_.rejectedFor(cause);
    tell(throttles_[static_cast<std::size_t>(cause)], "rejected", "turned away", nameOf(cause), who);
}

void RejectionLog::ended(CloseCause cause, const std::string& who) {
    ++counters_.closedBy(cause);
    if (cause == CloseCause::Left || cause == CloseCause::Drained) return;
    const auto place = static_cast<std::size_t>(cause);
    tell(endThrottles_[place], "session_ended", "a session was ended", closeCauseNames[place], who);
}

}  // namespace spherule::net

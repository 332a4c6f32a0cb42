#include "net/refusals.h"

#include "core/log.h"

namespace spherule::net {

void Refusals::add(Rejection cause, const std::string& who) {
    ++counters_.rejectedFor(cause);
    const auto more = throttles_[static_cast<std::size_t>(cause)].pass(Throttle::Clock::now());
    if (!more) return;
    logEvent(spdlog::level::info, "rejected", "turned away",
             {{"cause", std::string(nameOf(cause))}, {"from", who}, {"more", std::to_string(*more)}});
}

}  // namespace spherule::net

#include "sim/flow_meter.h"

#include <cmath>
#include <initializer_list>

namespace spherule::sim {

void FlowMeter::add(double time, std::uint64_t spheres, double mass) {
    last_ = before(time);
    if (const double second = std::floor(time); second != second_) {
        present_ = {};
        second_ = second;
    }
    for (Amount* const amount : {&total_, &present_}) {
        amount->spheres += spheres;
        amount->mass += mass;
    }
}

FlowMeter::Amount FlowMeter::before(double time) const {
    const double second = std::floor(time);
    if (second == second_) return last_;
    return second == second_ + 1 ? present_ : Amount{};
}

double FlowMeter::spheresPerSecond(double time) const {
    return static_cast<double>(before(time).spheres);
}

double FlowMeter::massPerSecond(double time) const {
    return before(time).mass;
}

}  // namespace spherule::sim

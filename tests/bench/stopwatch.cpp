#include "stopwatch.h"

#include <algorithm>
#include <chrono>

namespace spherule::bench {

namespace {

constexpr double slow = 2;       // s per substep
constexpr double verySlow = 30;  // s

struct Lane {
    Method* method = nullptr;
    unsigned substeps = 1;  // after each upload
    unsigned uploads = 1;   // per round
    unsigned rounds = 0;
    std::vector<double> seconds;  // per substep, by round
};

Lane laneFor(compute::Device& device, Method& method, const sim::State& state, const Effort& effort) {
    // The first substep also compiles kernels. It is repeated unless it takes 1 s or longer.
    double estimate = timeSubsteps(device, method, state, 1);
    if (estimate < 1) estimate = timeSubsteps(device, method, state, method.period()) / method.period();
    Lane lane;
    lane.method = &method;
    if (estimate > verySlow) {
        lane.seconds.push_back(estimate);
        return lane;
    }
    lane.rounds = estimate > slow ? std::min(effort.rounds, 3U) : effort.rounds;
    const double fitting = std::clamp(effort.roundSeconds / estimate, 1.0, double{mostSubsteps});
    lane.substeps = std::max(static_cast<unsigned>(fitting), method.period());
    lane.uploads = static_cast<unsigned>(std::max(1.0, effort.roundSeconds / (lane.substeps * estimate)));
    return lane;
}

}  // namespace

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::ranges::sort(values);
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double timeSubsteps(compute::Device& device, Method& method, const sim::State& state, unsigned substeps) {
    method.upload(state);
    device.finish();
    const auto begin = std::chrono::steady_clock::now();
    for (unsigned k = 0; k < substeps; ++k) method.substep();
    device.finish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::vector<Timing> race(compute::Device& device, std::span<Method* const> methods, const sim::State& state,
                         const Effort& effort) {
    std::vector<Lane> lanes;
    for (Method* method : methods) lanes.push_back(laneFor(device, *method, state, effort));
    for (unsigned round = 0; round < effort.rounds; ++round) {
        for (Lane& lane : lanes) {
            if (round >= lane.rounds) continue;
            double seconds = 0;
            for (unsigned k = 0; k < lane.uploads; ++k)
                seconds += timeSubsteps(device, *lane.method, state, lane.substeps);
            lane.seconds.push_back(seconds / (lane.uploads * lane.substeps));
        }
    }
    std::vector<Timing> timings;
    for (const Lane& lane : lanes)
        timings.push_back({median(lane.seconds), static_cast<unsigned>(lane.seconds.size())});
    return timings;
}

}  // namespace spherule::bench

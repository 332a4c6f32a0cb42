#include "app/run_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace spherule::app {

namespace {

nlohmann::ordered_json reportOf(const compute::DeviceInfo& device, sim::Simulation& simulation, const RunTimes& times) {
    const sim::Statistics s = simulation.statistics();
    const sim::State state = simulation.snapshot();
    return {
        {"scene", simulation.scene().name},
        {"device", device.kind},
        {"renderer", device.renderer},
        {"quality", "balanced"},
        {"spheres", simulation.count()},
        {"steps", simulation.steps()},
        {"substepsPerStep", simulation.scene().substeps},
        {"simSeconds", simulation.time()},
        {"wallSeconds", times.wallSeconds},
        {"deviceSeconds", times.deviceSeconds},
        {"kineticEnergy", s.kineticEnergy},
        {"rotationalEnergy", s.rotationalEnergy},
        {"potentialEnergy", s.potentialEnergy},
        {"momentum", {s.momentum.x, s.momentum.y, s.momentum.z}},
        {"contacts", s.contacts},
        {"overlapMean", s.overlapMean},
        {"overlapMax", s.overlapMax},
        {"wallOverlapMax", s.wallOverlapMax},
        {"speedMax", s.speedMax},
        {"speedRms", s.speedRms},
        {"meanHeight", s.meanHeight},
        {"sleeping", s.sleeping},
        {"outside", s.outside},
        {"nonFinite", s.nonFinite},
        {"stateHash", fmt::format("{:016x}", sim::hashOf(state))},
    };
}

}  // namespace

std::string runJson(const compute::DeviceInfo& device, sim::Simulation& simulation, const RunTimes& times) {
    return reportOf(device, simulation, times).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string runText(const compute::DeviceInfo& device, sim::Simulation& simulation, const RunTimes& times) {
    std::string text;
    const nlohmann::ordered_json report = reportOf(device, simulation, times);
    for (const auto& [key, value] : report.items())
        text += fmt::format("{:<16} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
    return text;
}

}  // namespace spherule::app

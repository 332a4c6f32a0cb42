#include "cli/run_report.h"

#include <fmt/format.h>

#include <numeric>

#include <nlohmann/json.hpp>

#include "scene/quality.h"

namespace spherule::cli {

namespace {

double realTimeFactor(const Interval& interval) {
    return interval.wallSeconds > 0 ? interval.simSeconds / interval.wallSeconds : 0;
}

nlohmann::ordered_json passesOf(const Interval& interval) {
    auto passes = nlohmann::ordered_json::object();
    for (unsigned pass = 0; pass < sim::passCount; ++pass) {
        const bool known = pass < interval.passSeconds.size();
        passes[std::string(nameOf(static_cast<sim::Pass>(pass)))] = known ? interval.passSeconds[pass] : 0.0;
    }
    return passes;
}

nlohmann::json forcesOf(const sim::Statistics& statistics) {
    auto forces = nlohmann::json::array();
    for (const sim::SurfaceForce& on : statistics.surfaceForces)
        forces.push_back({{"surface", on.surface},
                          {"force", {on.force.x, on.force.y, on.force.z}},
                          {"torque", {on.torque.x, on.torque.y, on.torque.z}}});
    return forces;
}

nlohmann::ordered_json flowOf(const sim::FlowCounts& flow) {
    return {{"spheres", flow.spheres},
            {"mass", flow.mass},
            {"spheresPerSecond", flow.spheresPerSecond},
            {"massPerSecond", flow.massPerSecond}};
}

nlohmann::ordered_json emittersOf(const sim::Statistics& statistics) {
    nlohmann::ordered_json emitters = nlohmann::ordered_json::array();
    for (const sim::EmitterCounts& one : statistics.emitters)
        emitters.push_back({{"name", one.name},
                            {"born", flowOf(one.born)},
                            {"blocked", one.blocked},
                            {"waiting", one.waiting},
                            {"ended", one.ended}});
    return emitters;
}

nlohmann::ordered_json sinksOf(const sim::Statistics& statistics) {
    nlohmann::ordered_json sinks = nlohmann::ordered_json::array();
    for (const sim::SinkCounts& one : statistics.sinks)
        sinks.push_back({{"taken", flowOf(one.taken)}, {"byMaterial", one.byMaterial}});
    return sinks;
}

nlohmann::ordered_json reportOf(const compute::DeviceInfo& device, sim::Simulation& simulation,
                                const Interval& interval) {
    const sim::Statistics& s = interval.end;
    const sim::Impacts impacts = s.impacts.since(interval.before);
    const auto ofImpacts = [&impacts](double ratio) { return impacts.count > 0 ? nlohmann::json(ratio) : nullptr; };
    const auto ofSums = [&s](const auto& value) { return s.contactSums ? nlohmann::json(value) : nullptr; };
    const sim::ContactSums sums = s.contactSums.value_or(sim::ContactSums());
    const sim::State state = simulation.snapshot();
    return {
        {"scene", simulation.scene().name},
        {"device", device.kind},
        {"renderer", device.renderer},
        {"quality", scene::nameOf(simulation.scene().quality.model)},
        {"spheres", simulation.count()},
        {"born", s.born},
        {"removed", s.removed},
        {"emitters", emittersOf(s)},
        {"sinks", sinksOf(s)},
        {"steps", simulation.steps()},
        {"substepsPerStep", simulation.scene().quality.substeps},
        {"simSeconds", simulation.time()},
        {"intervalSeconds", interval.simSeconds},
        {"wallSeconds", interval.wallSeconds},
        {"realTimeFactor", realTimeFactor(interval)},
        {"deviceSeconds", std::accumulate(interval.passSeconds.begin(), interval.passSeconds.end(), 0.0)},
        {"passSeconds", passesOf(interval)},
        {"rebuilds", interval.rebuilds},
        {"launches", interval.launches},
        {"longestChain", simulation.pipeline().longestChain()},
        {"kineticEnergy", s.kineticEnergy},
        {"rotationalEnergy", s.rotationalEnergy},
        {"elasticEnergy", s.elasticEnergy},
        {"potentialEnergy", s.potentialEnergy},
        {"pushWork", s.pushWork},
        {"momentum", {s.momentum.x, s.momentum.y, s.momentum.z}},
        {"angularMomentum", {s.angularMomentum.x, s.angularMomentum.y, s.angularMomentum.z}},
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
        {"impacts", static_cast<std::uint64_t>(impacts.count)},
        {"restitution", ofImpacts(impacts.restitution())},
        {"restitutionAsked", ofImpacts(impacts.restitutionAsked())},
        {"collisions", ofSums(static_cast<std::uint64_t>(sums.collisions))},
        {"dissipatedEnergy", ofSums(sums.dissipated)},
        {"kineticStress", ofSums(s.kineticStress)},
        {"contactStress", s.contactStress ? nlohmann::json(*s.contactStress) : nullptr},
        {"surfaceForces", ofSums(forcesOf(s))},
        {"stateHash", fmt::format("{:016x}", sim::hashOf(state))},
    };
}

}  // namespace

std::string runJson(const compute::DeviceInfo& device, sim::Simulation& simulation, const Interval& interval) {
    return reportOf(device, simulation, interval)
        .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string runText(const compute::DeviceInfo& device, sim::Simulation& simulation, const Interval& interval) {
    std::string text;
    const nlohmann::ordered_json report = reportOf(device, simulation, interval);
    for (const auto& [key, value] : report.items())
        text += fmt::format("{:<16} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
    return text;
}

const char* const runRowHeader =
    "   time, s   x real time    asleep   overlap, % of r: mean      max   speed, m/s: rms      max";

std::string runRow(sim::Simulation& simulation, const Interval& interval) {
    const sim::Statistics& s = interval.end;
    return fmt::format("{:>10.4g}{:>14.3g}{:>10}{:>25.3f}{:>9.3f}{:>19.4f}{:>9.3f}\n", simulation.time(),
                       realTimeFactor(interval), s.sleeping, 100 * s.overlapMean, 100 * s.overlapMax, s.speedRms,
                       s.speedMax);
}

}  // namespace spherule::cli

#include "sim/flows.h"

namespace spherule::sim {

namespace {

FlowCounts countsOf(const FlowMeter& meter, double time) {
    return {.spheres = meter.spheres(),
            .mass = meter.mass(),
            .spheresPerSecond = meter.spheresPerSecond(time),
            .massPerSecond = meter.massPerSecond(time)};
}

}  // namespace

void SinkFlow::add(double time, std::uint8_t material, double mass) {
    taken.add(time, 1, mass);
    ++byMaterial[material];
}

Flows::Flows(const scene::Scene& scene) : emission(scene, 0) {
    sinks.resize(scene.sinks.size());
    for (SinkFlow& sink : sinks) sink.byMaterial.resize(scene.materials.size());
}

void Flows::follow(const scene::PartChange& change, const scene::Scene& scene, double time) {
    using enum scene::PartChange::Part;
    using enum scene::PartChange::Kind;
    if (change.part == Emitters && change.kind == Added) emission.add(scene.emitters[change.number], time);
    if (change.part == Emitters && change.kind == Changed)
        emission.replace(change.number, scene.emitters[change.number], time);
    if (change.part == Emitters && change.kind == Removed) emission.remove(change.number);
    for (SinkFlow& sink : sinks) {
        if (change.part == Materials && change.kind == Added) sink.byMaterial.push_back(0);
        if (change.part == Materials && change.kind == Removed)
            sink.byMaterial.erase(sink.byMaterial.begin() + static_cast<std::ptrdiff_t>(change.number));
    }
}

void Flows::addTo(Statistics& statistics, const scene::Scene& scene) const {
    for (std::size_t k = 0; k < emission.emitters(); ++k) {
        const Emission::Counts counts = emission.counts(scene, k);
        statistics.emitters.push_back({.name = scene.emitters[k].name,
                                       .born = countsOf(counts.born, statistics.time),
                                       .blocked = counts.blocked,
                                       .waiting = counts.waiting,
                                       .ended = counts.ended});
    }
    for (const SinkFlow& sink : sinks)
        statistics.sinks.push_back({.taken = countsOf(sink.taken, statistics.time), .byMaterial = sink.byMaterial});
}

}  // namespace spherule::sim

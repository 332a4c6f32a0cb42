#pragma once

#include <cstdint>
#include <vector>

#include "scene/part_changes.h"
#include "scene/scene.h"
#include "sim/emission.h"
#include "sim/flow_meter.h"
#include "sim/statistics.h"

namespace spherule::sim {

// The spheres that a sink has taken.
struct SinkFlow {
    FlowMeter taken;
    std::vector<std::uint64_t> byMaterial;  // spheres, by index into Scene::materials

    void add(double time, std::uint8_t material, double mass);
    template <class Archive>
    void archive(Archive& a) {
        a(taken, byMaterial);
    }
};

// The spheres that emitters have made and sinks have taken since the world began.
struct Flows {
    Flows() = default;
    explicit Flows(const scene::Scene& scene);

    // Follows a change of the scene, which is `scene` now, at `time` (s simulated).
    void follow(const scene::PartChange& change, const scene::Scene& scene, double time);
    // Adds the counts to `statistics`, whose time is set.
    void addTo(Statistics& statistics, const scene::Scene& scene) const;
    template <class Archive>
    void archive(Archive& a) {
        a(emission, sinks);
    }

    Emission emission;
    std::vector<SinkFlow> sinks;
};

}  // namespace spherule::sim

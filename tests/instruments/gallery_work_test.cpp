// A substep of a scene of the program does no more work without one of its parts. The instrument counts what kernels
// read and write.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "gallery_removals.h"
#include "gallery_scenes.h"
#include "races.h"
#include "support.h"
#include "work_groups.h"

namespace spherule::instruments {
namespace {

using support::valueOf;

// A scene in the midst of its motion. Obstacles begin to move now, and no sphere sleeps: without sleep, or gravity,
// more spheres would be awake.
struct Start {
    scene::Scene scene;
    sim::State state;
};

Start startOf(const std::string& name) {
    const scene::Scene whole = physics::reduced(physics::named(name), 1'000);
    scene::Scene atRest = whole;
    for (scene::Obstacle& obstacle : atRest.obstacles) obstacle.motion.reset();
    const auto device = valueOf(compute::openDevice("cpu"));
    const auto simulation = physics::simulate(atRest, *device);
    physics::run(*simulation, 1.5);
    Start start{simulation->scene(), simulation->snapshot()};
    start.state.ids.clear();
    for (glm::vec4& velocity : start.state.velocity) velocity.w = std::abs(velocity.w);
    for (std::uint32_t k = 0; k < start.state.count(); ++k) {
        scene::Sphere& sphere = start.scene.spheres[k];
        sphere.position = positionOf(start.state, k) + start.scene.bounds.centre();
        sphere.velocity = glm::vec3(start.state.velocity[k]);
        sphere.spin = glm::vec3(start.state.spin[k]);
    }
    start.scene.obstacles = whole.obstacles;
    for (scene::Obstacle& obstacle : start.scene.obstacles)
        if (obstacle.motion) obstacle.motion->begin = 0;
    return start;
}

sim::State withoutFixed(const sim::State& state) {
    sim::State kept;
    for (std::uint32_t k = 0; k < state.count(); ++k) {
        if (isFixed(state, k)) continue;
        kept.position.push_back(state.position[k]);
        kept.velocity.push_back(state.velocity[k]);
        kept.spin.push_back(state.spin[k]);
        if (!state.images.empty()) kept.images.push_back(state.images[k]);
    }
    return kept;
}

// The reads and writes of a substep, and its launches.
struct Work {
    std::uint64_t bytes = 0;
    std::uint64_t launches = 0;
};

Work workOfSubstep(sim::Simulation& simulation) {
    takeTraffic();
    const std::uint64_t before = launches();
    valueOf(simulation.advance());
    Work work{.launches = launches() - before};
    for (const Traffic& row : takeTraffic()) work.bytes += row.bytesRead + row.bytesWritten;
    return work;
}

// The work of a substep with a rebuild of the lists, and of the next one.
struct Substeps {
    Work first;
    Work second;
};

Substeps workOf(const scene::Scene& scene, const sim::State& state) {
    const Chosen chosen(inWorkGroups());
    const auto device = valueOf(compute::openDevice("cpu:1x1"));
    const auto simulation = physics::simulate(scene, *device);
    simulation->observe(false);
    simulation->upload(state);
    Work first = workOfSubstep(*simulation);
    Work second = workOfSubstep(*simulation);
    takeRaces();
    return {std::move(first), std::move(second)};
}

// Returns the share by which the bytes may rise. Other impulses bring or end a few contacts within a substep, and more
// in the next one.
double slackOf(const std::string& part, bool rebuild) {
    // Without gravity, the slowest approaches are impacts, too. Without pair lists, there are no lists of near
    // obstacles, and more spheres read the impulses that obstacles hold.
    if (part == "gravity" || (part == "contacts" && !rebuild)) return 0.03;
    return rebuild ? 0.001 : 0.01;
}

void expectNoMore(const Work& without, const Work& whole, double slack, const std::string& what) {
    EXPECT_LE(static_cast<double>(without.bytes), (1 + slack) * static_cast<double>(whole.bytes)) << what;
    EXPECT_LE(without.launches, whole.launches) << what;
}

class GalleryWork : public testing::TestWithParam<std::string> {};

TEST_P(GalleryWork, OfASubstepIsNoMoreWithoutAPart) {
    const Start start = startOf(GetParam());
    const Substeps whole = workOf(start.scene, start.state);
    for (const physics::Removal& removal : physics::removalsFrom(start.scene)) {
        if (removal.part == "several radii") continue;  // other spheres would touch
        scene::Scene part = start.scene;
        removal.change(part);
        sim::State state = start.state;
        if (part.spheres.size() < state.count()) state = withoutFixed(state);
        part.spheres.resize(state.count());  // without samples of emitters
        const Substeps without = workOf(part, state);
        expectNoMore(without.first, whole.first, slackOf(removal.part, true), removal.part + ", with a rebuild");
        // The state differs by now. New walls throw out the spheres in them, which brings another rebuild.
        if (removal.part != "periodic axes")
            expectNoMore(without.second, whole.second, slackOf(removal.part, false), removal.part);
    }
}

// The largest of the three sizes of the default scene has more than 10,000 fixed spheres.
std::vector<std::string> scenes() {
    std::vector<std::string> names = physics::galleryScenes();
    std::erase(names, "rapids-50k");
    return names;
}

INSTANTIATE_TEST_SUITE_P(Of, GalleryWork, testing::ValuesIn(scenes()), physics::testNameOf);

}  // namespace
}  // namespace spherule::instruments

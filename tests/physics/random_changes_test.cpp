// Changes of the scene at random, and while the world goes on.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "part_support.h"
#include "scene/describe.h"
#include "scene/quality.h"
#include "scene/random.h"

namespace spherule::physics {
namespace {

class RandomChanges : public testing::TestWithParam<Model> {};

INSTANTIATE_TEST_SUITE_P(Of, RandomChanges, testing::Values(Model::Fast, Model::Balanced, Model::Accurate),
                         [](const auto& one) { return std::string(scene::nameOf(one.param)); });

// Edits at random, also wrong ones.
class Editor {
  public:
    explicit Editor(std::uint64_t seed) : random_(seed) {}

    sim::Command next() {
        const unsigned n = below(5);
        switch (below(14)) {
            case 0:
            case 1:
                return addField(field());
            case 2:
                return change<v1::ChangeField>(fmt::format(R"({{"number": {}, "field": {}}})", n, field()));
            case 3:
                return removeField(n);
            case 4:
            case 5:
                return change<v1::AddEmitter>(fmt::format(R"({{"emitter": {}}})", emitter()));
            case 6:
                return change<v1::ChangeEmitter>(fmt::format(R"({{"number": {}, "emitter": {}}})", n, emitter()));
            case 7:
                return change<v1::RemoveEmitter>(fmt::format(R"({{"number": {}}})", n));
            case 8:
                return change<v1::AddMaterial>(fmt::format(R"({{"material": {}}})", material()));
            case 9:
                return change<v1::ChangeMaterial>(fmt::format(R"({{"number": {}, "material": {}}})", n, material()));
            case 10:
                return change<v1::RemoveMaterial>(fmt::format(R"({{"number": {}}})", n));
            case 11:
                return change<v1::SetPair>(fmt::format(R"({{"pair": {{"a": "m{}", "b": "m{}", "friction": {}}}}})",
                                                       below(4), below(4), random_.uniform(-0.2, 1)));
            case 12:
                return change<v1::ChangeGroup>(fmt::format(R"({{"number": {}, "material": "m{}", "metal": {}}})", n,
                                                           below(4), random_.uniform(0, 1.2)));
            default:
                return sim::RemoveGroup{n + 1};
        }
    }
    unsigned below(unsigned end) { return static_cast<unsigned>(random_.uniform(0, end)); }

  private:
    std::string field() {
        static const std::vector<std::string> wrong = {R"({})", R"({"drag": {"density": -1}})",
                                                       R"({"spring": {"centre": [0, 0]}})"};
        return below(4) == 0 ? wrong[below(3)] : fields[below(5)];
    }
    std::string emitter() {
        return fmt::format(R"({{"name": "e{}", "sphere": {{"centre": [0, 0, {}], "radius": 0.2}}, "rate": {},
                               "radius": {{"constant": {}}}, "material": "m{}"}})",
                           below(3), random_.uniform(0.3, 1.3), random_.uniform(-10, 60), random_.uniform(0.02, 0.06),
                           below(4));
    }
    std::string material() {
        const std::string name = below(4) == 0 ? "" : fmt::format("m{}", below(4));
        return fmt::format(R"({{"name": "{}", "density": {}, "friction": {}, "rollingResistance": {}}})", name,
                           random_.uniform(200, 3000), random_.uniform(-0.1, 0.8), below(2) == 0 ? 0.0 : 0.02);
    }

    scene::Random random_;
};

TEST_P(RandomChanges, AtRandomKeepTheWorldWhole) {
    for (const std::uint64_t seed : {1U, 2U}) {
        Editor editor(seed);
        scene::Scene scene =
            fallingBox(GetParam(), R"(, "sinks": [{"region": {"min": [-0.5, -0.5, 0], "max": [0.5, -0.3, 0.1]}}])",
                       R"({"name": "m0", "friction": 0.3})");
        if (GetParam() == Model::Accurate) scene.quality.overlap = 0.3;
        auto simulation = simulate(scene);
        unsigned refused = 0;
        for (int k = 0; k < 200; ++k) {
            const sim::Command command = editor.next();
            const std::uint64_t hash = sim::hashOf(simulation->snapshot());
            const std::string before = described(*simulation);
            const sim::Features features = simulation->plan().features;
            if (const auto applied = simulation->apply(command); !applied) {
                ++refused;
                EXPECT_EQ(sim::hashOf(simulation->snapshot()), hash) << applied.error().text();
                EXPECT_EQ(described(*simulation), before) << applied.error().text();
                EXPECT_EQ(simulation->plan().features, features);
            }
            for (unsigned substeps = editor.below(12); substeps > 0; --substeps) ASSERT_TRUE(simulation->advance());
            const sim::Statistics now = simulation->statistics();
            ASSERT_EQ(now.born, now.spheres + now.removed) << k;
            ASSERT_EQ(now.nonFinite, 0U) << k;
            std::vector<std::uint32_t> counts(simulation->scene().groups.size());
            for (const scene::Sphere& sphere : simulation->scene().spheres) {
                ASSERT_EQ(sphere.material, simulation->scene().groups.at(sphere.group).material) << k;
                ++counts[sphere.group];
            }
            for (std::size_t g = 0; g < counts.size(); ++g)
                ASSERT_EQ(counts[g], simulation->scene().groups[g].count) << k;
        }
        EXPECT_GT(refused, 20U);
        EXPECT_LT(refused, 150U);
        // It can be saved and read again.
        const v1::Scene saved = scene::describe(simulation->scene(), simulation->time(),
                                                simulation->flows().emission.progress(simulation->scene()));
        v1::Scene empty = saved;
        for (v1::Group& group : *empty.mutable_groups()) group.mutable_list();
        const auto again = scene::build(empty);
        EXPECT_TRUE(again) << again.error().text();
        apply(*simulation, sim::Reset{});
        EXPECT_EQ(described(*simulation), described(*simulate(scene)));
    }
}

// Statistics, figures, contacts of a sphere and saved states are read in one of two simulations, also between a command
// and the next substep.
TEST_P(RandomChanges, ReadingMakesNoDifference) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        Editor editor(seed);
        scene::Random random(seed);
        scene::Scene scene = fallingBox(GetParam());
        if (GetParam() == Model::Accurate) scene.quality.overlap = 0.3;
        const auto read = simulate(scene);
        const auto unread = simulate(scene);
        for (int k = 0; k < 60; ++k) {
            const sim::Command command = [&]() -> sim::Command {
                if (k % 4 == 1) return sim::Set{.model = static_cast<Model>(editor.below(3))};
                if (k % 4 == 3) return sim::Remove{.spheres = {editor.below(80)}};
                return editor.next();
            }();
            EXPECT_EQ(read->apply(command).has_value(), unread->apply(command).has_value());
            for (unsigned steps = editor.below(4); steps > 0; --steps) {
                switch (editor.below(4)) {
                    case 0:
                        EXPECT_EQ(read->statistics().nonFinite, 0U);
                        break;
                    case 1:
                        EXPECT_TRUE(read->pipeline().figures());
                        break;
                    case 2:
                        EXPECT_EQ(read->contactCounts().size(), read->count());
                        break;
                    default:
                        EXPECT_TRUE(read->save());
                        break;
                }
                ASSERT_TRUE(read->step());
                ASSERT_TRUE(unread->step());
                ASSERT_EQ(sim::hashOf(read->snapshot()), sim::hashOf(unread->snapshot())) << seed << ", " << k;
            }
        }
    }
}

// The state to which the world returns has the groups and emitters of the changed scene.
TEST_P(RandomChanges, TheWorldGoesBackWithItsChanges) {
    auto simulation = simulate(emptyBox(std::string(jet) + "," + jet, GetParam()));
    run(*simulation, 0.5);
    apply(*simulation, change<v1::RemoveEmitter>(R"({"number": 0})"));
    apply(*simulation, sim::RemoveGroup{0});
    apply(*simulation, change<v1::AddMaterial>(R"({"material": {"name": "new"}})"));
    ASSERT_TRUE(simulation->step());
    sim::State broken = simulation->snapshot();
    broken.velocity[0].x = std::numeric_limits<float>::quiet_NaN();
    simulation->upload(broken);
    ASSERT_TRUE(simulation->step());
    ASSERT_TRUE(simulation->counters().nonFinite);
    simulation->rollback();
    EXPECT_EQ(simulation->scene().groups.size(), 1U);
    EXPECT_EQ(simulation->scene().groups[0].count, simulation->count());
    run(*simulation, 0.3);
    const sim::Statistics now = simulation->statistics();
    ASSERT_EQ(now.emitters.size(), 1U);
    EXPECT_EQ(now.nonFinite, 0U);
    EXPECT_EQ(simulation->scene().groups[0].count, simulation->count());
}

TEST_P(RandomChanges, AnEndedPreparationChangesNothing) {
    auto simulation = simulate(fallingBox(GetParam()));
    auto untouched = simulate(fallingBox(GetParam()));
    for (int pieces = 0; pieces < 60; pieces += 6) {
        auto outcome = simulation->begin(addField(fields[1]));
        ASSERT_TRUE(outcome);
        for (int k = 0; k < pieces; ++k) {
            const auto done = outcome->preparation->advance();
            ASSERT_TRUE(done);
            if (*done) break;
        }
    }
    EXPECT_EQ(described(*simulation), described(*untouched));
    EXPECT_EQ(hashAfter(*simulation, 0.2), hashAfter(*untouched, 0.2));
}

// Returns the launches of a substep.
std::uint64_t launchesOfSubstep(sim::Simulation& simulation) {
    const std::uint64_t before = simulation.pipeline().launches();
    EXPECT_TRUE(simulation.advance());
    return simulation.pipeline().launches() - before;
}

// A rebuild that is due waits while its kernels are not launched. So they must be launched in the same substeps,
// whether lists were built to read the state or not.
TEST_P(RandomChanges, ReadingDoesNotChangeWhatIsLaunched) {
    scene::Scene scene = sceneOf(R"({"bounds": {"min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 1]}, "gravity": [0, 0, 0],
        "materials": [{"name": "m0", "friction": 0.3}],
        "groups": [{"material": "m0", "fill": {"min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 1], "count": 400},
                    "radius": {"uniform": {"min": 0.01, "max": 0.03}}}]})");
    scene.quality.model = GetParam();
    scene.sleep.enabled = false;
    const auto read = simulate(scene);
    const auto unread = simulate(scene);
    for (const Model other : {Model::Fast, Model::Balanced, Model::Accurate}) {
        for (const Model model : {other, GetParam()}) {
            ASSERT_TRUE(read->apply(sim::Set{.model = model}));
            ASSERT_TRUE(unread->apply(sim::Set{.model = model}));
        }
        ASSERT_TRUE(read->pipeline().figures());
        for (int substep = 0; substep < 8; ++substep)
            EXPECT_EQ(launchesOfSubstep(*read), launchesOfSubstep(*unread)) << scene::nameOf(other) << ", " << substep;
        EXPECT_EQ(sim::hashOf(read->snapshot()), sim::hashOf(unread->snapshot()));
    }
}

struct Beside {
    bool holds = false;     // the change was not refused
    unsigned substeps = 0;  // that the world has done before
};

// Carries out a command while the world does `substeps()` after each piece of its preparation.
Beside changeBeside(sim::Simulation& simulation, const sim::Command& command,
                    const std::function<unsigned()>& substeps) {
    Beside beside;
    auto outcome = simulation.begin(command);
    if (!outcome) return beside;
    while (outcome->preparation) {
        const auto done = outcome->preparation->advance();
        if (!done) return beside;
        if (*done) simulation.adopt(std::move(outcome->preparation));
        if (*done || !outcome->preparation->letsStep()) continue;
        for (unsigned left = substeps(); left > 0; --left, ++beside.substeps) EXPECT_TRUE(simulation.advance());
    }
    beside.holds = true;
    return beside;
}

// All that decides the bits of a plan.
auto decidingPartsOf(const sim::Plan& plan) {
    return std::tuple(plan.features, plan.spheres, plan.room, plan.pairCapacity, plan.mostMovers, plan.maxWallHistory,
                      plan.grid);
}

// A replay of a command log makes a change at once, where it began to hold. Spheres are born and removed between the
// begin of the change and that place, so that the cells and the room for spheres are others.
TEST_P(RandomChanges, BesideTheWorldAreTheSameAsAtOnce) {
    unsigned beside = 0;
    for (const std::uint64_t seed : {1U, 2U}) {
        Editor editor(seed);
        const scene::Scene scene = sceneOf(fmt::format(
            R"({{"bounds": {{"min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 1]}}, "quality": {{"model": "{}"}},
                 "materials": [{{"name": "m0", "friction": 0.3}}], "emitters": [{}],
                 "sinks": [{{"region": {{"min": [-0.5, -0.5, 0], "max": [0.5, -0.1, 0.1]}}}}]}})",
            GetParam() == Model::Fast       ? "FAST"
            : GetParam() == Model::Balanced ? "BALANCED"
                                            : "ACCURATE",
            jet));
        const auto run = simulate(scene);
        const auto replay = simulate(scene);
        for (int k = 0; k < 25; ++k) {
            const sim::Command command = editor.next();
            const std::uint32_t before = run->count();
            const Beside change =
                changeBeside(*run, command, [&] { return editor.below(4) == 0 ? run->substeps() : 1; });
            for (unsigned left = change.substeps; left > 0; --left) ASSERT_TRUE(replay->advance());
            if (!change.holds) continue;
            beside += run->count() > before ? 1 : 0;
            apply(*replay, command);
            const std::string where = fmt::format("seed {}, change {}", seed, k);
            EXPECT_TRUE(decidingPartsOf(run->plan()) == decidingPartsOf(replay->plan())) << where;
            for (int steps = 0; steps < 2; ++steps) {
                ASSERT_TRUE(run->step());
                ASSERT_TRUE(replay->step());
            }
            ASSERT_EQ(sim::hashOf(run->snapshot()), sim::hashOf(replay->snapshot())) << where;
        }
    }
    EXPECT_GT(beside, 5U) << "spheres were born beside";
}

// A preparation lets the world go on, and takes over what has changed meanwhile.
TEST_P(RandomChanges, TheWorldGoesOnWhileKernelsAreMade) {
    auto simulation = simulate(emptyBox(jet, GetParam()));
    run(*simulation, 0.1);
    auto outcome = simulation->begin(addField(fields[1]));
    ASSERT_TRUE(outcome);
    ASSERT_TRUE(outcome->preparation);
    EXPECT_TRUE(outcome->preparation->letsStep());
    for (;;) {
        const auto done = outcome->preparation->advance();
        ASSERT_TRUE(done) << done.error().text();
        if (*done) break;
        if (outcome->preparation->letsStep()) run(*simulation, 0.05);
    }
    const std::uint64_t hash = sim::hashOf(simulation->snapshot());
    const std::uint32_t count = simulation->count();
    EXPECT_GT(count, 64U + 20U) << "the arrays had to grow";
    EXPECT_TRUE(simulation->scene().forces.fields.empty());
    simulation->adopt(std::move(outcome->preparation));
    EXPECT_EQ(sim::hashOf(simulation->snapshot()), hash);
    EXPECT_EQ(simulation->count(), count);
    EXPECT_EQ(simulation->scene().forces.fields.size(), 1U);
    run(*simulation, 0.5);
    const sim::Statistics now = simulation->statistics();
    EXPECT_EQ(now.born, now.spheres + now.removed);
    EXPECT_EQ(now.nonFinite, 0U);
    EXPECT_GT(now.spheres, count);
}

}  // namespace
}  // namespace spherule::physics

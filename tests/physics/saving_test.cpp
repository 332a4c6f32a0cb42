// A simulation that is restored from a saved state goes on with the same bits. SPHERULE_SAVING_SECONDS sets the
// simulated time after the state is saved (s); the default is six steps. The long test saving_long runs 1 s, on the
// software renderer too.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "checkpoint/saved_world.h"
#include "gallery_scenes.h"
#include "part_support.h"
#include "scene/archive.h"
#include "scene/quality.h"
#include "scene/random.h"

namespace spherule::physics {
namespace {

// With several threads, lists have the same pairs in an order that differs from run to run, and the same results. With
// one thread, all arrays are the same.
compute::Device& oneThread() {
    static const auto made = compute::openDevice("cpu:1").value();
    return *made;
}

compute::Device& allThreads() {
    static const auto made = compute::openDevice("cpu").value();
    return *made;
}

bool lastsLong() {
    return std::getenv("SPHERULE_SAVING_SECONDS") != nullptr;
}

// The device of a test: in the long test, the one of the environment.
compute::Device& chosen() {
    return lastsLong() ? device() : oneThread();
}

std::unique_ptr<sim::Simulation> restored(const sim::SavedState& saved, compute::Device& on = chosen()) {
    auto made = sim::Simulation::restore(on, saved);
    if (!made) throw std::runtime_error(made.error().text());
    // Scratch arrays may hold anything.
    for (const sim::ArraySpec& spec : (*made)->plan().arrays)
        if (sim::typeOf(spec.array).scratch) on.fill(*(*made)->buffer(spec.array), 0xa5a5a5a5);
    return std::move(*made);
}

// Reports the first part in which two states differ.
void expectSame(sim::Simulation& one, sim::Simulation& other, const std::string& when) {
    ASSERT_EQ(sim::hashOf(one.snapshot()), sim::hashOf(other.snapshot())) << when;
    const auto a = one.save().value();
    const auto b = other.save().value();
    ASSERT_EQ(a.arrays.size(), b.arrays.size()) << when;
    for (std::size_t k = 0; k < a.arrays.size() && !lastsLong(); ++k)
        ASSERT_EQ(a.arrays[k].bytes == b.arrays[k].bytes, true) << when << ": " << nameOf(a.arrays[k].array);
    ASSERT_EQ(a.host == b.host, true) << when << ": on the host";
}

// Returns the largest number of free spheres in a variant. A second in the model `accurate` is thousands of substeps,
// which take minutes on the software renderer with more spheres.
std::uint32_t mostSpheres(scene::Model model) {
    if (!lastsLong()) return 500;
    return model == scene::Model::Accurate && chosen().info().kind == "software" ? 200 : 2'000;
}

class SavedGallery : public testing::TestWithParam<std::pair<std::string, scene::Model>> {};

std::vector<std::pair<std::string, scene::Model>> scenesInModels() {
    std::vector<std::pair<std::string, scene::Model>> all;
    for (const std::string& name : galleryScenes())
        for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate})
            all.emplace_back(name, model);
    return all;
}

TEST_P(SavedGallery, GoesOnWithTheSameBits) {
    const auto& [name, model] = GetParam();
    scene::Scene scene = reduced(named(name), mostSpheres(model));
    if (model != scene.quality.model) {
        auto changed = sim::changedBy({.model = model}, std::move(scene));
        // Some scenes have parts that a model cannot compute: there is no state of them to save.
        if (!changed) {
            EXPECT_EQ(changed.error().kind, ErrorKind::Refused) << changed.error().text();
            return;
        }
        scene = std::move(*changed);
    }
    const long few = std::clamp(std::lround(400.0 / scene.quality.substeps), 1L, 6L);
    const long after = lastsLong() ? std::lround(std::stod(std::getenv("SPHERULE_SAVING_SECONDS")) / scene.step) : few;
    const auto undisturbed = simulate(scene, chosen());
    const auto simulation = simulate(scene, chosen());
    for (long k = 0; k < few + 1; ++k) {
        ASSERT_TRUE(undisturbed->step());
        ASSERT_TRUE(simulation->step());
    }
    const auto again = restored(simulation->save().value());
    expectSame(*again, *simulation, "at once");
    for (long k = 0; k < after; ++k) {
        ASSERT_TRUE(undisturbed->step());
        ASSERT_TRUE(again->step());
    }
    expectSame(*again, *undisturbed, "at the end");
    if (lastsLong()) return;
    for (long k = 0; k < after; ++k) ASSERT_TRUE(simulation->step());
    EXPECT_EQ(sim::hashOf(simulation->snapshot()), sim::hashOf(undisturbed->snapshot())) << "saving has an effect";
}

INSTANTIATE_TEST_SUITE_P(Of, SavedGallery, testing::ValuesIn(scenesInModels()), [](const auto& one) {
    std::string name = fmt::format("{}_{}", one.param.first, scene::nameOf(one.param.second));
    std::ranges::replace(name, '-', '_');
    return name;
});

class Saved : public testing::TestWithParam<scene::Model> {};

INSTANTIATE_TEST_SUITE_P(Of, Saved, testing::Values(scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate),
                         [](const auto& one) { return std::string(scene::nameOf(one.param)); });

// Commands at random, of all kinds that change the world.
sim::Command commandAtRandom(scene::Random& random, std::uint32_t spheres) {
    const auto below = [&](unsigned end) { return static_cast<unsigned>(random.uniform(0, end)); };
    const auto vector = [&](double most) {
        return glm::dvec3(random.uniform(-most, most), random.uniform(-most, most), random.uniform(0, most));
    };
    switch (below(9)) {
        case 0:
            return addField(fields[below(static_cast<unsigned>(fields.size()))]);
        case 1:
            return removeField(below(2));
        case 2:
            return change<v1::AddEmitter>(R"({"emitter": {"name": "rain", "sphere": {"centre": [0, 0, 1.2],
                "radius": 0.2}, "rate": 90, "radius": {"uniform": {"min": 0.03, "max": 0.05}}}})");
        case 3:
            return sim::Set{.gravity = vector(9.81) - glm::dvec3(0, 0, 9.81)};
        case 4:
            return sim::Push{.target = std::uint64_t{below(spheres)}, .impulse = vector(0.5)};
        case 5:
            return sim::Pull{.session = below(3), .sphere = below(spheres), .point = vector(0.5)};
        case 6:
            return sim::Remove{.spheres = {below(spheres)}};
        case 7:
            return sim::Set{.substeps = 8 + below(8)};
        default:
            return sim::Set{.friction = random.uniform(0, 0.8)};
    }
}

// Also of the state to which a reset returns, and after fast spheres have raised the substeps.
TEST_P(Saved, GoesOnAfterCommandsAtRandom) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        scene::Random random(seed);
        scene::Scene scene =
            fallingBox(GetParam(), R"(, "sinks": [{"region": {"min": [-0.5, -0.5, 0], "max": [0.5, -0.3, 0.1]}}])");
        if (GetParam() == scene::Model::Accurate) scene.quality.overlap = 0.3;
        auto simulation = simulate(scene, chosen());
        unsigned done = 0;
        for (int round = 0; round < 12; ++round) {
            for (int k = 0; k < 3; ++k) done += simulation->apply(commandAtRandom(random, simulation->count())) ? 1 : 0;
            const auto steps = static_cast<int>(random.uniform(0, 8));
            for (int k = 0; k < steps; ++k) ASSERT_TRUE(simulation->step());
            auto again = restored(simulation->save().value());
            expectSame(*again, *simulation, fmt::format("seed {}, round {}", seed, round));
            const sim::Command next = commandAtRandom(random, simulation->count());
            EXPECT_EQ(simulation->apply(next).has_value(), again->apply(next).has_value());
            for (int k = 0; k < 4; ++k) {
                ASSERT_TRUE(simulation->step());
                ASSERT_TRUE(again->step());
            }
            expectSame(*again, *simulation, fmt::format("seed {}, after round {}", seed, round));
            if (round % 2 == 1) simulation = std::move(again);
        }
        EXPECT_GT(done, 15U);
        auto again = restored(simulation->save().value());
        for (sim::Simulation* const one : {simulation.get(), again.get()}) {
            ASSERT_TRUE(one->apply(sim::Reset{}));
            for (int k = 0; k < 5; ++k) ASSERT_TRUE(one->step());
        }
        expectSame(*again, *simulation, "after a reset");
    }
}

// After a sphere has become non-finite, both return to the same state.
TEST_P(Saved, ReturnsToTheLastGoodState) {
    scene::Scene scene = fallingBox(GetParam());
    const auto simulation = simulate(scene, chosen());
    for (int k = 0; k < 70; ++k) ASSERT_TRUE(simulation->step());
    const auto again = restored(simulation->save().value());
    for (sim::Simulation* const one : {simulation.get(), again.get()}) {
        one->rollback();
        for (int k = 0; k < 5; ++k) ASSERT_TRUE(one->step());
    }
    expectSame(*again, *simulation, "after a rollback");
}

class SavedBed : public testing::Test {
  protected:
    SavedBed() {
        for (int k = 0; k < 30; ++k) EXPECT_TRUE(bed_->step());
    }
    std::unique_ptr<sim::Simulation> bed_ = simulate(named("box-50k"), lastsLong() ? device() : allThreads());
};

// From spheres that fall to a bed at rest: lists of movers alone come and go.
TEST(SavedStates, GoOnWhileSpheresFallAsleep) {
    const auto simulation = simulate(named("box-4k"), oneThread());
    for (int k = 0; k < 87; ++k) ASSERT_TRUE(simulation->step());
    for (int round = 0; round < 40; ++round) {
        const auto again = restored(simulation->save().value(), oneThread());
        for (int k = 0; k < 5; ++k) {
            ASSERT_TRUE(simulation->step());
            ASSERT_TRUE(again->step());
        }
        expectSame(*again, *simulation, fmt::format("round {}", round));
    }
    EXPECT_GT(simulation->statistics().sleeping, 3'000U);
}

// Also of a bed with 50,000 spheres.
TEST_F(SavedBed, GoesOnWithTheSameBits) {
    const auto again = restored(bed_->save().value(), lastsLong() ? device() : allThreads());
    for (int k = 0; k < (lastsLong() ? 300 : 3); ++k) {
        ASSERT_TRUE(bed_->step());
        ASSERT_TRUE(again->step());
    }
    EXPECT_EQ(sim::hashOf(again->snapshot()), sim::hashOf(bed_->snapshot()));
}

// In the same run, by turns: medians of the time to save the state and to copy its arrays.
TEST_F(SavedBed, TakesAtMostTwiceAsLongAsACopy) {
    const auto secondsOf = [](const auto& work) {
        const auto begin = std::chrono::steady_clock::now();
        work();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    std::vector<double> ratios;
    for (int k = 0; k < 21; ++k) {
        const double copy = secondsOf([&] { EXPECT_GT(bed_->pipeline().saveArrays().size(), 10U); });
        const double save = secondsOf([&] { EXPECT_TRUE(bed_->save()); });
        ratios.push_back(save / copy);
    }
    std::ranges::sort(ratios);
    RecordProperty("ratio", fmt::format("{:.2f}", ratios[10]));
    EXPECT_LE(ratios[10], 2);
}

// The file is at most 1.2 times as large as the state in memory.
TEST_F(SavedBed, IsLittleLargerThanTheState) {
    std::uint64_t bytes = 0;
    const auto saved = bed_->save().value();
    const std::uint64_t state = saved.bytes();
    checkpoint::Position position;
    ASSERT_TRUE(checkpoint::write({.head = {}, .state = bed_->save().value()}, position, [&](const std::string& more) {
        bytes += more.size();
        return Result<void>();
    }));
    RecordProperty("share", fmt::format("{:.2f} of {:.1f} MB", static_cast<double>(bytes) / static_cast<double>(state),
                                        static_cast<double>(state) / 1e6));
    EXPECT_LE(static_cast<double>(bytes), 1.2 * static_cast<double>(state));
}

// A change of the saved types needs another format: see tests/golden/checkpoint.
TEST(SavedStates, OfAnEarlierProgramAreRead) {
    const auto world = checkpoint::readCheckpoint(SPHERULE_GOLDEN "/checkpoint/format-1.sphc");
    ASSERT_TRUE(world) << world.error().text();
    const auto again = restored(world->state, oneThread());
    EXPECT_EQ(again->steps(), 3U);
    ASSERT_TRUE(again->step());
    const auto undisturbed = simulate(named("two-spheres"), oneThread());
    for (int k = 0; k < 4; ++k) ASSERT_TRUE(undisturbed->step());
    EXPECT_EQ(sim::hashOf(again->snapshot()), sim::hashOf(undisturbed->snapshot()));
}

// The processors and the software renderer give the same bits, so a state of one goes on on the other.
TEST(SavedStates, GoOnOnAnotherDevice) {
    const auto renderer = compute::openDevice("software").value();
    for (const char* const name : {"cradle", "pour"}) {
        const auto simulation = simulate(reduced(named(name), 100), oneThread());
        for (int k = 0; k < 12; ++k) ASSERT_TRUE(simulation->step());
        const auto onRenderer = restored(simulation->save().value(), *renderer);
        for (int k = 0; k < 3; ++k) {
            ASSERT_TRUE(simulation->step());
            ASSERT_TRUE(onRenderer->step());
        }
        EXPECT_EQ(sim::hashOf(onRenderer->snapshot()), sim::hashOf(simulation->snapshot())) << name;
        const auto back = restored(onRenderer->save().value(), oneThread());
        ASSERT_TRUE(simulation->step());
        ASSERT_TRUE(back->step());
        EXPECT_EQ(sim::hashOf(back->snapshot()), sim::hashOf(simulation->snapshot())) << name;
    }
}

TEST(SavedStates, AreRefusedWithinAStep) {
    scene::Scene scene = sleepyBox(1);
    scene.spheres.push_back({.radius = 0.1F});
    const auto simulation = simulate(scene, oneThread());
    ASSERT_FALSE(simulation->advance().value());
    EXPECT_EQ(simulation->save().error().kind, ErrorKind::Refused);
}

// Other values of the same type that are wrong are not found: a checksum of the file has to do that.
TEST(SavedStates, AreRefusedIfASphereHasNoSlotOrNoMaterial) {
    const auto simulation = simulate(reduced(named("hopper"), 200), oneThread());
    ASSERT_TRUE(simulation->step());
    for (const std::uint32_t changed : {0xffU << 24U, 0xffffffU, 1U}) {
        sim::SavedState saved = simulation->save().value();
        const auto words =
            std::ranges::find(saved.arrays, sim::Array::IdAndMaterial, &sim::Pipeline::SavedArray::array);
        ASSERT_NE(words, saved.arrays.end());
        std::uint32_t word = 0;
        std::memcpy(&word, words->bytes.data(), sizeof word);
        word ^= changed;
        std::memcpy(words->bytes.data(), &word, sizeof word);
        EXPECT_FALSE(sim::Simulation::restore(oneThread(), saved)) << changed;
    }
}

TEST(SavedStates, AreRefusedWhenTheyAreCutOffOrOfAnotherScene) {
    const auto simulation = simulate(reduced(named("hopper"), 200), oneThread());
    ASSERT_TRUE(simulation->step());
    const sim::SavedState saved = simulation->save().value();
    const auto copyOf = [](const sim::SavedState& state) {
        return sim::SavedState{.host = state.host, .arrays = state.arrays};
    };
    ASSERT_TRUE(sim::Simulation::restore(oneThread(), saved));
    for (std::size_t end = 0; end < saved.host.size(); end += 1 + saved.host.size() / 500) {
        sim::SavedState cut = copyOf(saved);
        cut.host.resize(end);
        EXPECT_FALSE(sim::Simulation::restore(oneThread(), cut)) << end;
    }
    sim::SavedState longer = copyOf(saved);
    longer.host += '\0';
    EXPECT_FALSE(sim::Simulation::restore(oneThread(), longer));
    for (std::size_t k = 0; k < saved.arrays.size(); ++k) {
        sim::SavedState missing = copyOf(saved);
        missing.arrays.erase(missing.arrays.begin() + static_cast<std::ptrdiff_t>(k));
        EXPECT_FALSE(sim::Simulation::restore(oneThread(), missing)) << nameOf(saved.arrays[k].array);
        sim::SavedState shorter = copyOf(saved);
        shorter.arrays[k].bytes.resize(shorter.arrays[k].bytes.size() - 4);
        EXPECT_FALSE(sim::Simulation::restore(oneThread(), shorter)) << nameOf(saved.arrays[k].array);
    }
}

}  // namespace
}  // namespace spherule::physics

// The largest error of a decoded position, for all shipped scenes and tiers: half a quantum plus float32 rounding. The
// encoder computes floor(fl(fl(x fl(1 / quantum)) + 0.5)) in float32, where x is relative to the centre of the bounds.
// There are three roundings of at most 2^-24 each, of values up to |x| + quantum / 2. So the error is at most
//
//     quantum / 2 + 3 * 2^-24 * (|x| + quantum / 2)
//
// per axis. The decoder uses double, whose roundings are 2^29 times smaller. The slack in the last product covers them
// and the products of two roundings.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "codec/decoder.h"
#include "codec/rendition.h"
#include "compute/device.h"
#include "scene/catalog.h"
#include "scene/json.h"
#include "scene/load.h"
#include "sim/morton.h"
#include "sim/simulation.h"
#include "sim/tier.h"
#include "value_of.h"

namespace spherule::codec {
namespace {

constexpr std::array tiers{v1::FINE, v1::NORMAL, v1::ECO};

using support::valueOf;

double bound(double x, double quantum) {
    return quantum / 2 + 3 * std::ldexp(std::abs(x) + quantum / 2, -24);
}

// Larger lattices are cut to this number of spheres. `stress-1m` keeps its width, which determines the rounding, but
// has only some layers.
constexpr std::uint32_t mostSpheres = 100'000;

scene::Scene sceneOf(const std::string& name) {
    const auto text = scene::embeddedScene(name, "cpu");
    if (!text) throw std::runtime_error("no scene " + name);
    v1::Scene message = valueOf(scene::parseJson(std::string(*text), name));
    for (v1::Group& group : *message.mutable_groups())
        if (group.has_lattice() && group.lattice().count() > mostSpheres)
            group.mutable_lattice()->set_count(mostSpheres);
    return valueOf(scene::build(message));
}

// One chain with two decoders: one from the start, and one from a resync keyframe in the middle.
struct Chain {
    Chain(sim::TierTools& tools, double step)
        : quantum(step), tier(valueOf(sim::Tier::create(tools, {.quantum = step}))) {}

    double quantum;  // m
    std::unique_ptr<sim::Tier> tier;
    std::unique_ptr<codec::Decoder> first, joined;
    double worst = 0;  // error, in quanta
};

class CodecError : public testing::TestWithParam<std::string> {
  protected:
    CodecError()
        : device_(valueOf(compute::openDevice("cpu"))),
          simulation_(valueOf(sim::Simulation::create(*device_, sceneOf(GetParam())))),
          tools_(valueOf(sim::TierTools::create(*device_, simulation_->count(), source().slotOf != nullptr))) {
        order_ = sim::mortonOrder(simulation_->snapshot().position);
        tools_->setOrder(order_);
        for (const v1::Tier tier : tiers)
            chains_.emplace_back(*tools_, codec::quantumOf(tier, simulation_->radii().smallest));
    }

    sim::TierSource source() { return simulation_->tierSource(); }

    void step(int steps) {
        for (int k = 0; k < steps; ++k)
            if (const auto done = simulation_->step(); !done) throw std::runtime_error(done.error().text());
    }

    void take(Chain& chain, std::unique_ptr<codec::Decoder>& decoder, const sim::State& state) {
        if (!decoder) decoder = std::make_unique<codec::Decoder>(simulation_->count());
        const auto head = decoder->apply(chain.tier->download());
        ASSERT_TRUE(head) << head.error().text();
        const auto cells = decoder->newest();
        std::size_t beyond = 0;
        for (std::size_t k = 0; k < cells.size(); ++k) {
            for (int axis = 0; axis < 3; ++axis) {
                const auto x = static_cast<double>(state.position[order_[k]][axis]);
                const double error = std::abs(chain.quantum * cells[k][axis] - x);
                if (!(error <= bound(x, chain.quantum))) ++beyond;
                chain.worst = std::max(chain.worst, error / chain.quantum);
            }
        }
        EXPECT_EQ(beyond, 0U) << "worst " << chain.worst << " quanta of " << chain.quantum << " m, frame "
                              << head->number;
    }

    std::unique_ptr<compute::Device> device_;
    std::unique_ptr<sim::Simulation> simulation_;
    std::unique_ptr<sim::TierTools> tools_;
    std::vector<std::uint32_t> order_;
    std::vector<Chain> chains_;
};

// Fewer steps for more spheres. With 30 steps between frames, small scenes get through their impacts.
TEST_P(CodecError, StaysWithinTheStatedBound) {
    constexpr int frames = 6;
    const std::uint32_t spheres = simulation_->count();
    const int between = std::clamp(static_cast<int>(20'000 / spheres), 1, 30);
    step(2 * between);
    for (int frame = 0; frame <= frames; ++frame) {
        if (frame > 0) step(between);
        const sim::State state = simulation_->snapshot();
        for (Chain& chain : chains_) {
            frame == 0 ? chain.tier->begin(source(), true) : chain.tier->next(source(), true);
            take(chain, chain.first, state);
            if (frame > frames / 2) take(chain, chain.joined, state);
            if (frame != frames / 2) continue;
            chain.tier->join(true);
            take(chain, chain.joined, state);
        }
    }
    // With many spheres some are nearly half way between two grid points. Otherwise the comparison would prove nothing.
    if (spheres < 1000) return;
    for (const Chain& chain : chains_) EXPECT_GT(chain.worst, 0.499);
}

INSTANTIATE_TEST_SUITE_P(Scenes, CodecError, testing::ValuesIn(scene::names()), [](const auto& named) {
    std::string name = named.param;
    std::ranges::replace(name, '-', '_');
    return name;
});

}  // namespace
}  // namespace spherule::codec

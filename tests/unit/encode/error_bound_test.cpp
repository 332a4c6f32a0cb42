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
#include "encode/column_encoder.h"
#include "encode/morton.h"
#include "scene/catalog.h"
#include "scene/json.h"
#include "scene/load.h"
#include "sim/simulation.h"
#include "value_of.h"

namespace spherule::codec {
namespace {

constexpr std::array tiers{v1::FINE, v1::NORMAL, v1::ECO};

using support::valueOf;

double bound(double x, double quantum) {
    return quantum / 2 + 3 * std::ldexp(std::abs(x) + quantum / 2, -24);
}

// Larger lattices are cut to this number of spheres in all. `stress-1m` keeps its width, which determines the rounding,
// but has only some layers.
constexpr std::uint32_t mostSpheres = 100'000;

// Returns a scene with emitters as it is after two seconds, without emitters and sinks: the number of spheres stays.
scene::Scene afterBirths(scene::Scene scene) {
    const auto device = valueOf(compute::openDevice("cpu"));
    const auto simulation = valueOf(sim::Simulation::create(*device, scene));
    while (simulation->time() < 2) valueOf(simulation->advance());
    const sim::State state = simulation->snapshot();
    scene.spheres = simulation->scene().spheres;
    for (std::uint32_t k = 0; k < state.count(); ++k) {
        scene.spheres[k].position = sim::positionOf(state, k) + scene.bounds.centre();
        scene.spheres[k].velocity = glm::vec3(state.velocity[k]);
    }
    scene.groups = simulation->scene().groups;
    scene.emitters.clear();
    scene.sinks.clear();
    return scene;
}

scene::Scene sceneOf(const std::string& name) {
    const auto text = scene::embeddedScene(name, "cpu");
    if (!text) throw std::runtime_error("no scene " + name);
    v1::Scene message = valueOf(scene::parseJson(std::string(*text), name));
    const std::uint32_t most = mostSpheres / static_cast<std::uint32_t>(std::max(1, message.groups_size()));
    for (v1::Group& group : *message.mutable_groups())
        if (group.has_lattice() && group.lattice().count() > most) group.mutable_lattice()->set_count(most);
    scene::Scene scene = valueOf(scene::build(message));
    return scene.emitters.empty() ? scene : afterBirths(std::move(scene));
}

// One chain with two decoders: one from the start, and one from a resync keyframe in the middle.
struct Chain {
    Chain(encode::EncoderContext& context, double step)
        : quantum(step), frames(valueOf(encode::ColumnEncoder::create(context, {.quantum = step}))) {}

    double quantum;  // m
    std::unique_ptr<encode::ColumnEncoder> frames;
    std::unique_ptr<codec::Decoder> first, joined;
    double worst = 0;  // error, in quanta
};

class CodecError : public testing::TestWithParam<std::string> {
  protected:
    CodecError()
        : device_(valueOf(compute::openDevice("cpu"))),
          simulation_(valueOf(sim::Simulation::create(*device_, sceneOf(GetParam())))),
          context_(
              valueOf(encode::EncoderContext::create(*device_, simulation_->count(), source().slotOf != nullptr))) {
        order_ = encode::mortonOrder(simulation_->snapshot().position);
        context_->setOrder(order_);
        for (const v1::Tier tier : tiers)
            encoder_.emplace_back(*context_, codec::quantumOf(tier, simulation_->radii().smallest));
    }

    encode::ColumnSource source() {
        return {simulation_->buffer(sim::Array::Position), simulation_->buffer(sim::Array::SlotOf)};
    }

    void step(int steps) {
        for (int k = 0; k < steps; ++k)
            if (const auto done = simulation_->step(); !done) throw std::runtime_error(done.error().text());
    }

    void take(Chain& chain, std::unique_ptr<codec::Decoder>& decoder, const sim::State& state) {
        if (!decoder) decoder = std::make_unique<codec::Decoder>(simulation_->count());
        const auto head = decoder->apply(chain.frames->download());
        ASSERT_TRUE(head) << head.error().text();
        const auto cells = decoder->newest();
        const glm::dvec3 periods = simulation_->scene().bounds.periods();  // an image of the sphere may be decoded
        std::size_t beyond = 0;
        for (std::size_t k = 0; k < cells.size(); ++k) {
            for (int axis = 0; axis < 3; ++axis) {
                const auto x = static_cast<double>(state.position[order_[k]][axis]);
                double off = chain.quantum * cells[k][axis] - x;
                if (periods[axis] > 0) off -= periods[axis] * std::round(off / periods[axis]);
                const double error = std::abs(off);
                if (!(error <= bound(x, chain.quantum))) ++beyond;
                chain.worst = std::max(chain.worst, error / chain.quantum);
            }
        }
        EXPECT_EQ(beyond, 0U) << "worst " << chain.worst << " quanta of " << chain.quantum << " m, frame "
                              << head->number;
    }

    std::unique_ptr<compute::Device> device_;
    std::unique_ptr<sim::Simulation> simulation_;
    std::unique_ptr<encode::EncoderContext> context_;
    std::vector<std::uint32_t> order_;
    std::vector<Chain> encoder_;
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
        for (Chain& chain : encoder_) {
            frame == 0 ? chain.frames->encodeKeyframe(source(), true) : chain.frames->encodeDelta(source(), true);
            take(chain, chain.first, state);
            if (frame > frames / 2) take(chain, chain.joined, state);
            if (frame != frames / 2) continue;
            chain.frames->encodeResync(true);
            take(chain, chain.joined, state);
        }
    }
    // With many spheres some are nearly half way between two grid points. Otherwise the comparison would prove nothing.
    if (spheres < 1000) return;
    for (const Chain& chain : encoder_) EXPECT_GT(chain.worst, 0.499);
}

INSTANTIATE_TEST_SUITE_P(Scenes, CodecError, testing::ValuesIn(scene::names()), [](const auto& named) {
    std::string name = named.param;
    std::ranges::replace(name, '-', '_');
    return name;
});

}  // namespace
}  // namespace spherule::codec

#include "baseline.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "embedded/benchKernels.h"
#include "sim/features.h"
#include "sim/parameters.h"
#include "sim/shaders.h"

namespace spherule::bench {

namespace {

using sim::layout::uint;
#include "kernels/tally.h"

class Sources final : public compute::SourceSet {
  public:
    [[nodiscard]] std::optional<std::string_view> find(std::string_view name) const override {
        for (const embedded::File& file : embedded::benchKernels())
            if (file.path == name) return file.bytes;
        return sim::shaders().find(name);
    }
};

}  // namespace

const compute::SourceSet& benchSources() {
    static const Sources sources;
    return sources;
}

Setting settingFor(compute::Device& device, sim::Simulation& simulation, bool count) {
    return {device,
            sim::parametersFor(simulation.scene(), simulation.plan(), sim::radiusStatsOf(simulation.scene()),
                               simulation.scene().step / simulation.substeps()),
            count};
}

Baseline::Baseline(const Setting& setting, State state) : setting_(setting), state_(state) {
    define("COUNT", setting.count ? "true" : "false");
    const std::size_t bytes = std::size_t{setting.parameters.spheres} * 16;
    for (unsigned half = 0; half < 2; ++half) {
        position_[half] = array("positions", bytes);
        velocity_[half] = array("velocities", bytes);
    }
    tally_ = array("tally", TALLY_WORDS * 4);
    parameters_ = array("parameters", sizeof setting.parameters);
    if (!failed_) setting_.device.upload(*parameters_, 0, std::as_bytes(std::span(&setting_.parameters, 1)));
}

compute::Buffer* Baseline::array(std::string_view label, std::size_t bytes) {
    if (failed_) return nullptr;
    auto made = setting_.device.createBuffer(label, bytes);
    if (!made) {
        failed_ = true;
        error_ = made.error();
        return nullptr;
    }
    return arrays_.emplace_back(std::move(*made)).get();
}

std::vector<compute::Buffer*> Baseline::swapped(std::vector<compute::Buffer*> buffers) const {
    if (state_ == State::InPlace) return buffers;
    for (compute::Buffer*& buffer : buffers) {
        for (const auto* halves : {&position_, &velocity_}) {
            const auto found = std::ranges::find(*halves, buffer);
            if (found == std::end(*halves)) continue;
            buffer = found == std::begin(*halves) ? (*halves)[1] : (*halves)[0];
            break;
        }
    }
    return buffers;
}

void Baseline::stage(std::string_view kernel, std::vector<compute::Buffer*> buffers, std::uint32_t count,
                     std::uint32_t phase) {
    if (failed_) return;
    auto made = setting_.device.createKernel(benchSources(), kernel, defines_);
    if (!made) {
        failed_ = true;
        error_ = made.error();
        return;
    }
    auto odd = swapped(buffers);
    stages_.push_back(
        {kernels_.emplace_back(std::move(*made)).get(), {std::move(buffers), std::move(odd)}, count, phase});
}

void Baseline::response(std::string_view kernel, const std::vector<compute::Buffer*>& buffers) {
    // InPlace: the sort has written the state to the second half; the response writes it back to the first.
    const unsigned from = state_ == State::InPlace ? 1 : 0;
    std::vector<compute::Buffer*> all = {position_[from], velocity_[from], position_[1 - from], velocity_[1 - from],
                                         tally_};
    all.insert(all.end(), buffers.begin(), buffers.end());
    stage(kernel, std::move(all), setting_.parameters.spheres);
}

Result<void> Baseline::ready() const {
    if (failed_) return tl::unexpected(error_);
    return {};
}

void Baseline::upload(const sim::State& state) {
    setting_.device.upload(*position_[0], 0, std::as_bytes(std::span(state.position)));
    setting_.device.upload(*velocity_[0], 0, std::as_bytes(std::span(state.velocity)));
    setting_.device.fill(*tally_, 0);
    substeps_ = 0;
}

void Baseline::substep() {
    for (const Stage& stage : stages_) {
        setting_.device.launch({.kernel = stage.kernel,
                                .buffers = stage.buffers[substeps_ % 2],
                                .parameters = parameters_,
                                .phase = stage.phase,
                                .count = stage.count});
    }
    ++substeps_;
}

std::vector<glm::vec4> Baseline::positions() {
    std::vector<glm::vec4> values(setting_.parameters.spheres);
    const unsigned half = state_ == State::PingPong ? substeps_ % 2 : 0;
    setting_.device.download(*position_[half], 0, std::as_writable_bytes(std::span(values)));
    return values;
}

std::vector<std::uint32_t> Baseline::tally() {
    std::vector<std::uint32_t> words(TALLY_WORDS);
    setting_.device.download(*tally_, 0, std::as_writable_bytes(std::span(words)));
    return words;
}

std::uint64_t Baseline::contacts() {
    return tally()[TALLY_CONTACTS] / 2;
}

std::uint32_t Baseline::overflowed() {
    return tally()[TALLY_OVERFLOWED];
}

std::string Baseline::note() {
    const std::uint32_t lost = overflowed();
    return lost == 0 ? "" : fmt::format("{} spheres per substep found their cell full", lost / std::max(substeps_, 1U));
}

}  // namespace spherule::bench

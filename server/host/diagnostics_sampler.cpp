#include "host/diagnostics_sampler.h"

#include <algorithm>
#include <utility>

#include "host/to_proto.h"

namespace spherule::host {

namespace {

constexpr double noticeable = 1.2;  // ratio of two costs that differ enough for a new dial
// Either is enough for a mean time per step.
constexpr std::uint64_t enoughSteps = 10;
constexpr double enoughMs = 300;

// Returns true when contacts may store energy that the statistics do not show. In `balanced`: contacts that an impact
// has squeezed, because the bed expands again. In `accurate`: crowds without pair lists.
bool storesUnseen(const sim::Simulation& simulation, const sim::Statistics& statistics) {
    constexpr double squeezed = 0.05;  // of the radius
    const scene::Model model = simulation.scene().quality.model;
    return (model == scene::Model::Balanced && statistics.deepest() > squeezed) ||
           (model == scene::Model::Accurate && simulation.counters().unlisted > 0);
}

void addPasses(v1::Diagnostics& diagnostics, const std::vector<double>& seconds, std::uint64_t steps) {
    if (steps == 0) return;
    for (std::size_t pass = 0; pass < seconds.size(); ++pass) {
        if (!(seconds[pass] > 0)) continue;
        v1::PassTime& time = *diagnostics.add_passes();
        time.set_pass(std::string(sim::nameOf(static_cast<sim::Pass>(pass))));
        time.set_step_ms(1000 * seconds[pass] / static_cast<double>(steps));
    }
    std::ranges::sort(*diagnostics.mutable_passes(), std::greater(), &v1::PassTime::step_ms);
}

}  // namespace

void DiagnosticsSampler::addStep(double wallMs) {
    ++steps_;
    ms_ += wallMs;
}

bool DiagnosticsSampler::updateDial(const sim::Simulation& simulation, std::uint32_t epoch) {
    // dialFor() looks at every sphere. So it runs only when the epoch, the births or a setting that affects the dial
    // change.
    v1::ServerMessage settings = settingsMessage(simulation.scene(), 1, false);
    settings.mutable_settings()->clear_model();
    settings.mutable_settings()->clear_substeps();
    settings.mutable_settings()->clear_auto_();
    if (epoch != epoch_) {
        ratio_ = 0;
        impacts_ = {};
        sums_ = {};
    }
    epoch_ = epoch;
    std::string basis =
        std::to_string(epoch) + ' ' + std::to_string(simulation.population().born()) + settings.SerializeAsString();
    if (basis == basis_) return false;
    basis_ = std::move(basis);
    dial_ = diagnostics::dialFor(table_, simulation.scene());
    energy_ = {};
    discard();
    return true;
}

DiagnosticsSampler::Sample DiagnosticsSampler::sample(sim::Simulation& simulation,
                                                      const std::vector<double>& passSeconds) {
    Sample sample;
    v1::Diagnostics& diagnostics = sample.diagnostics;
    sim::Statistics statistics = simulation.statistics();
    statistics.impacts = statistics.impacts.since(std::exchange(impacts_, statistics.impacts));
    if (const auto& sums = statistics.contactSums)
        sim::setMeans(statistics, sums->since(std::exchange(sums_, *sums)), simulation.scene());
    *diagnostics.mutable_statistics() = statisticsMessage(statistics);
    diagnostics.set_substeps(simulation.substeps());
    addPasses(diagnostics, passSeconds, steps_);
    if (simulation.substeps() != substeps_) energy_.invalidateBaseline();
    substeps_ = simulation.substeps();
    if (steps_ > 0) diagnostics.set_step_ms(ms_ / static_cast<double>(steps_));
    if (steps_ >= enoughSteps || ms_ >= enoughMs) sample.dialChanged = calibrate(simulation, diagnostics.step_ms());
    if (steps_ > 0 || energy_.fresh())
        if (auto alarm = energy_.check({.step = simulation.steps(),
                                        .kinetic = statistics.kineticEnergy + statistics.rotationalEnergy,
                                        .potential = statistics.potentialEnergy,
                                        .fields = statistics.fieldEnergy,
                                        .elastic = statistics.elasticEnergy,
                                        .given = statistics.pushWork - statistics.unboundedEnergy,
                                        .soft = storesUnseen(simulation, statistics)}))
            sample.alarms.push_back(std::move(*alarm));
    if (auto alarm = overlap_.check(simulation.steps(), statistics.deepest()))
        sample.alarms.push_back(std::move(*alarm));
    diagnostics.set_energy_rises(energy_.alarmed());
    discard();
    return sample;
}

bool DiagnosticsSampler::calibrate(const sim::Simulation& simulation, double stepMs) {
    const double estimate = diagnostics::estimateMs(dial_, simulation.scene().quality.model, simulation.substeps());
    if (!(estimate > 0) || !(stepMs > 0)) return false;
    const double ratio = stepMs / estimate;
    if (ratio_ > 0 && ratio < noticeable * ratio_ && ratio_ < noticeable * ratio) return false;
    ratio_ = ratio;
    return true;
}

}  // namespace spherule::host

#include "measure/bench.h"

#include <cmath>

#include "scene/quality.h"

namespace spherule::measure {

namespace {

Result<void> fit(scene::Scene& scene, const Rung& rung) {
    scene.quality.model = rung.model;
    scene.quality.substepsFixed = false;
    if (auto fits = scene::checkModel(scene); !fits) return fits;
    if (auto fits = scene::fitSubsteps(scene); !fits) return fits;
    if (rung.factor == 1) return {};
    const double wanted = rung.factor * scene.quality.substeps;
    if (wanted < 1) return fail(ErrorKind::Refused, "", "less than one substep a step");
    scene.quality.substepsFixed = true;
    scene.quality.substeps = static_cast<std::uint32_t>(std::lround(wanted));
    return scene::fitSubsteps(scene);
}

}  // namespace

double takeSubstepSeconds(compute::Device& device) {
    const std::vector<double> seconds = device.takeTimes();
    double sum = 0;
    for (unsigned pass = 0; pass < seconds.size(); ++pass)
        if (pass != static_cast<unsigned>(sim::Pass::Statistics) && pass != static_cast<unsigned>(sim::Pass::Pack))
            sum += seconds[pass];
    return sum;
}

Result<std::unique_ptr<sim::Simulation>> Bench::open(scene::Scene scene) {
    if (auto fits = fit(scene, outcome_.rung); !fits) return tl::unexpected(fits.error());
    return openAsIs(std::move(scene));
}

Result<std::unique_ptr<sim::Simulation>> Bench::openBySubstep(scene::Scene scene) {
    if (auto fits = fit(scene, outcome_.rung); !fits) return tl::unexpected(fits.error());
    scene.step /= scene.quality.substeps;
    scene.quality.substeps = 1;
    scene.quality.substepsFixed = true;
    return openAsIs(std::move(scene));
}

Result<std::unique_ptr<sim::Simulation>> Bench::openAsIs(scene::Scene scene) {
    outcome_.substeps = scene.quality.substeps;
    outcome_.substep = scene.step / scene.quality.substeps;
    outcome_.spheres = static_cast<std::uint32_t>(scene.spheres.size());
    auto simulation = sim::Simulation::create(device_, std::move(scene));
    startClock();
    return simulation;
}

void Bench::startClock() {
    static_cast<void>(device_.takeTimes());
    simulated_ = 0;
}

Result<void> Bench::step(sim::Simulation& simulation) {
    simulated_ += simulation.scene().step;
    return simulation.step();
}

Result<void> Bench::run(sim::Simulation& simulation, double seconds) {
    const auto steps = std::lround(seconds / simulation.scene().step);
    for (long k = 0; k < steps; ++k)
        if (auto done = step(simulation); !done) return done;
    return {};
}

Outcome Bench::finish() {
    outcome_.cost = simulated_ > 0 ? takeSubstepSeconds(device_) / simulated_ : 0;
    return std::move(outcome_);
}

}  // namespace spherule::measure

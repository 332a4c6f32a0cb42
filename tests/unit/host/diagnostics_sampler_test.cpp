#include "host/diagnostics_sampler.h"

#include <gtest/gtest.h>

#include "diagnostics/table.h"
#include "scene/load.h"

namespace spherule::host {
namespace {

// The lattice falls, and its overlaps are largest in step 34. Then it expands.
TEST(DiagnosticsSampler, RaisesNoAlarmWhenACompressedBedExpands) {
    const auto device = compute::openDevice("cpu").value();
    auto simulation = sim::Simulation::create(*device, scene::load("box-4k", "cpu", {}).value()).value();
    DiagnosticsSampler sampler(diagnostics::ownTable());
    sampler.updateDial(*simulation, 1);
    const auto step = [&](int count) {
        for (int k = 0; k < count; ++k) {
            ASSERT_TRUE(simulation->step());
            sampler.addStep(1);
        }
    };
    step(34);
    const auto squeezed = sampler.sample(*simulation, {});
    step(4);
    const auto expanded = sampler.sample(*simulation, {});
    const auto energyOf = [](const DiagnosticsSampler::Sample& sample) {
        return sample.diagnostics.statistics().kinetic_energy() + sample.diagnostics.statistics().potential_energy();
    };
    EXPECT_GT(energyOf(expanded), 1.02 * energyOf(squeezed)) << "this is no test";
    for (const std::string& alarm : expanded.alarms) ADD_FAILURE() << alarm;
    EXPECT_FALSE(expanded.diagnostics.energy_rises());
}

}  // namespace
}  // namespace spherule::host

#include "app/observer.h"

#include <gtest/gtest.h>

#include "quality/table.h"
#include "scene/load.h"

namespace spherule::app {
namespace {

// The lattice falls, and its overlaps are largest in step 34. Then it expands.
TEST(Observer, HearsNoAlarmWhenABedThatWasSqueezedExpands) {
    const auto device = compute::openDevice("cpu").value();
    auto simulation = sim::Simulation::create(*device, scene::load("box-4k", "cpu", {}).value()).value();
    Observer observer(quality::ownTable());
    observer.refresh(*simulation, 1);
    const auto step = [&](int count) {
        for (int k = 0; k < count; ++k) {
            ASSERT_TRUE(simulation->step());
            observer.stepped(1);
        }
    };
    step(34);
    const auto squeezed = observer.look(*simulation, {});
    step(4);
    const auto expanded = observer.look(*simulation, {});
    const auto energyOf = [](const Observer::Sight& sight) {
        return sight.diagnostics.statistics().kinetic_energy() + sight.diagnostics.statistics().potential_energy();
    };
    EXPECT_GT(energyOf(expanded), 1.02 * energyOf(squeezed)) << "this is no test";
    for (const std::string& alarm : expanded.alarms) ADD_FAILURE() << alarm;
    EXPECT_FALSE(expanded.diagnostics.energy_rises());
}

}  // namespace
}  // namespace spherule::app

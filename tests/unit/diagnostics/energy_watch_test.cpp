#include "diagnostics/energy_watch.h"

#include <gtest/gtest.h>

namespace spherule::diagnostics {
namespace {

// Takes a reading with this kinetic energy `times` times; returns the number of messages.
int read(EnergyWatch& watch, double joules, int times = 1) {
    int said = 0;
    for (int k = 0; k < times; ++k) said += watch.check({.step = 7, .kinetic = joules, .potential = 0}) ? 1 : 0;
    return said;
}

TEST(EnergyWatch, DoesNotReportFallingOrConstantEnergy) {
    EnergyWatch watch;
    for (double joules = 100; joules > 1; joules *= 0.9) EXPECT_EQ(read(watch, joules), 0);
    EXPECT_EQ(read(watch, 1, 20), 0);
    EXPECT_FALSE(watch.alarmed());
}

TEST(EnergyWatch, ReportsARiseOnceWithBothEnergies) {
    EnergyWatch watch;
    read(watch, 100, 3);
    const auto told = watch.check({.step = 42, .kinetic = 60, .potential = 42});
    ASSERT_TRUE(told);
    EXPECT_EQ(told->find("at step 42, mechanical energy has risen by 2 J to 102 J"), 0U) << *told;
    EXPECT_TRUE(watch.alarmed());
    EXPECT_EQ(read(watch, 110) + read(watch, 120) + read(watch, 140), 0) << "once until it is quiet";
}

TEST(EnergyWatch, IgnoresRounding) {
    EnergyWatch watch;
    read(watch, 100, 3);
    EXPECT_EQ(read(watch, 100.9, 20), 0);
}

TEST(EnergyWatch, IgnoresRoundingWherePotentialsCancel) {
    EnergyWatch watch;
    for (int k = 0; k < 20; ++k)
        EXPECT_FALSE(watch.check({.step = 7, .kinetic = 1e-6, .potential = 1e-5 * k, .fields = -100}));
}

TEST(EnergyWatch, ReportsAgainAfterAQuietPeriod) {
    EnergyWatch watch;
    read(watch, 100);
    EXPECT_EQ(read(watch, 105), 1);
    read(watch, 105, 12);
    EXPECT_FALSE(watch.alarmed());
    EXPECT_EQ(read(watch, 110), 1);
}

TEST(EnergyWatch, ReportsASlowRise) {
    EnergyWatch watch;
    int said = 0;
    double joules = 100;
    for (int k = 0; k < 40; ++k) said += read(watch, joules *= 1.002);
    EXPECT_GE(said, 1);
}

TEST(EnergyWatch, IgnoresEnergyStoredBrieflyInContacts) {
    EnergyWatch watch;
    for (int k = 0; k < 20; ++k) {
        EXPECT_EQ(read(watch, 100), 0);
        EXPECT_EQ(read(watch, 60), 0);
    }
}

TEST(EnergyWatch, IncludesElasticEnergy) {
    EnergyWatch watch;
    EXPECT_FALSE(watch.check({.kinetic = 60, .elastic = 40})) << "in the middle of an impact";
    EXPECT_FALSE(watch.check({.kinetic = 100}));
    EXPECT_TRUE(watch.check({.kinetic = 100, .elastic = 10}));
}

TEST(EnergyWatch, WaitsAfterAReadingOfSoftSpheres) {
    EnergyWatch watch;
    EXPECT_FALSE(watch.check({.kinetic = 60, .soft = true}));
    EXPECT_EQ(read(watch, 70), 0) << "it expands";
    EXPECT_EQ(read(watch, 70, 3), 0);
    EXPECT_EQ(read(watch, 80), 1);
}

TEST(EnergyWatch, RestartsAfterACommand) {
    EnergyWatch watch;
    read(watch, 100, 10);
    watch.invalidateBaseline();
    EXPECT_EQ(read(watch, 500, 10), 0);
    EXPECT_FALSE(watch.alarmed());
}

TEST(EnergyWatch, UsesAThresholdRelativeToBothEnergies) {
    EnergyWatch watch;
    watch.check({.step = 1, .kinetic = 1000, .potential = -999});
    EXPECT_FALSE(watch.check({.step = 2, .kinetic = 2000, .potential = -1998.5})) << "half a joule of 4000 is rounding";
}

}  // namespace
}  // namespace spherule::diagnostics

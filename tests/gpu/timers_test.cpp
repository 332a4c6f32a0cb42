#include <chrono>

#include "device_fixture.h"

namespace spherule::compute {
namespace {

constexpr const char* busyLoop = R"(
    layout(std430, binding = 0) buffer Values { uint values[]; };
    void main() {
        uint i = self();
        if (i >= invocations) return;
        uint x = i;
        for (uint n = 0u; n < phase; n++) x = x * 1664525u + 1013904223u;
        values[i] = x;
    })";

TEST_F(DeviceTest, TimesArePerSlotAndResetWhenTaken) {
    const auto busy = kernel(busyLoop);
    const auto values = buffer(4096 * 4);
    device_->beginTimer(1);
    launch(*busy, 4096, {values.get()}, 1000);
    device_->endTimer();
    device_->beginTimer(3);
    device_->endTimer();
    const auto times = device_->takeTimes();
    ASSERT_EQ(times.size(), 4U);
    EXPECT_EQ(times[0], 0.0);
    EXPECT_GT(times[1], 0.0);
    EXPECT_EQ(times[2], 0.0);
    EXPECT_GE(times[3], 0.0);
    EXPECT_GT(times[1], times[3]);
    EXPECT_TRUE(device_->takeTimes().empty());
}

TEST_F(DeviceTest, TimersThatAreOffMeasureNothing) {
    device_->useTimers(false);
    device_->beginTimer(2);
    device_->endTimer();
    EXPECT_TRUE(device_->takeTimes().empty());
    device_->useTimers(true);
    device_->beginTimer(2);
    device_->endTimer();
    EXPECT_EQ(device_->takeTimes().size(), 3U);
}

TEST_F(DeviceTest, TimeIncludesTheLaunchesBetweenBeginAndEnd) {
    const auto busy = kernel(busyLoop);
    const auto values = buffer(65536 * 4);
    launch(*busy, 65536, {values.get()}, 1);
    device_->finish();
    const auto begin = std::chrono::steady_clock::now();
    device_->beginTimer(0);
    launch(*busy, 65536, {values.get()}, 3000);
    device_->endTimer();
    device_->finish();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    const double measured = device_->takeTimes().at(0);
    EXPECT_LE(measured, 1.02 * wall.count());  // the two clocks differ slightly
    EXPECT_GE(measured, 0.5 * wall.count());
}

TEST_F(DeviceTest, TimersOfOneSlotAreSummed) {
    const auto busy = kernel(busyLoop);
    const auto values = buffer(256);
    for (int i = 0; i < 10000; ++i) {
        device_->beginTimer(0);
        launch(*busy, 64, {values.get()}, 10);
        device_->endTimer();
    }
    const auto times = device_->takeTimes();
    ASSERT_EQ(times.size(), 1U);
    EXPECT_GT(times[0], 0.0);
    EXPECT_LT(times[0], 60.0);
}

}  // namespace
}  // namespace spherule::compute

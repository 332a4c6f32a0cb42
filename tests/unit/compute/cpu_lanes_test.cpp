#include <gtest/gtest.h>

#include <string>

#include "compute/cpu/device.h"
#include "compute/cpu/host.h"
#include "compute/device.h"
#include "lanes_faults.h"

namespace spherule::compute::cpu {
namespace {

TEST(CpuLanes, EachOperationGivesTheBitsOfSingleValues) {
    EXPECT_STREQ(lanes4::firstFault(), nullptr);
    if (mostLanes() >= 8) {
        EXPECT_STREQ(lanes8::firstFault(), nullptr);
    }
    if (mostLanes() >= 16) {
        EXPECT_STREQ(lanes16::firstFault(), nullptr);
    }
}

std::string rendererOf(const std::string& choice) {
    const auto device = compute::openDevice(choice);
    return device ? (*device)->info().renderer : device.error().text();
}

TEST(CpuLanes, DeviceChoiceGivesThreadsAndLanes) {
    EXPECT_TRUE(rendererOf("cpu:2x1").ends_with(", 2 threads, 1 lane")) << rendererOf("cpu:2x1");
    EXPECT_TRUE(rendererOf("cpu:1x4").ends_with(", 1 thread, 4 lanes")) << rendererOf("cpu:1x4");
    // No more than the processor has.
    const std::string most = std::to_string(mostLanes()) + " lanes";
    EXPECT_TRUE(rendererOf("cpu:3x16").ends_with(", 3 threads, " + most)) << rendererOf("cpu:3x16");
    EXPECT_TRUE(rendererOf("cpu:3").ends_with(", 3 threads, " + most)) << rendererOf("cpu:3");
    EXPECT_TRUE(rendererOf("cpu").ends_with(most)) << rendererOf("cpu");
    EXPECT_TRUE(rendererOf("cpu-double:2").ends_with(", 2 threads, double precision")) << rendererOf("cpu-double:2");
}

TEST(CpuLanes, InvalidNumbersOfLanesAreRefusedWithTheChoices) {
    for (const auto* const choice : {"cpu:2x", "cpu:2x0", "cpu:2x2", "cpu:2x3", "cpu:2x32", "cpu:2x-4", "cpu:2x8x",
                                     "cpu:x8", "cpu:0x8", "cpu:2X8", "cpu-double:2x4"}) {
        const auto device = compute::openDevice(choice);
        ASSERT_FALSE(device.has_value()) << choice;
        EXPECT_EQ(device.error().kind, ErrorKind::Input) << choice;
        EXPECT_NE(device.error().message.find("cpu:NxL (L lanes: 1, 4, 8 or 16)"), std::string::npos)
            << device.error().text();
    }
}

}  // namespace
}  // namespace spherule::compute::cpu

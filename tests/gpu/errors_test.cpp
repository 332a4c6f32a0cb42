#include "core/log.h"
#include "device_fixture.h"

namespace spherule::compute {
namespace {

class DeviceDeathTest : public DeviceTest {
  protected:
    static void SetUpTestSuite() { startLog(false, LogFormat::Text); }

    // The child process restarts the program and opens its own device, because Mesa's threads do not survive a fork.
    void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }

    std::unique_ptr<Kernel> setter_ = kernel(R"(
        layout(std430, binding = 0) buffer Values { uint values[]; };
        layout(std430, binding = 3) buffer Others { uint others[]; };
        void main() { uint i = self(); if (i < invocations) values[i] = others[i]; })");
    std::unique_ptr<Buffer> values_ = buffer(16);
};

TEST_F(DeviceDeathTest, MissingBufferEndsTheProgramWithKernelAndSlot) {
    const std::string expected = "test.comp is launched without a buffer for Others at slot 3";
    EXPECT_DEATH(launch(*setter_, 1, {values_.get()}), expected);
    EXPECT_DEATH(launch(*setter_, 1, {values_.get(), nullptr, nullptr, nullptr}), expected);
}

TEST_F(DeviceDeathTest, MissingParametersEndTheProgram) {
    const auto scaled = kernel(R"(
        layout(std140, binding = 0) uniform Parameters { uint factor; };
        layout(std430, binding = 0) buffer Values { uint values[]; };
        void main() { uint i = self(); if (i < invocations) values[i] = factor; })");
    EXPECT_DEATH(launch(*scaled, 1, {values_.get()}), "test.comp is launched without its parameters");
}

TEST_F(DeviceDeathTest, AccessBeyondABufferEndsTheProgram) {
    std::vector<std::uint32_t> host(3);
    const auto bytes = std::as_writable_bytes(std::span(host));
    EXPECT_DEATH(device_->upload(*values_, 8, bytes), "upload of 12 bytes at 8 in a buffer of 16");
    EXPECT_DEATH(device_->download(*values_, 20, bytes), "download of 12 bytes at 20");
    EXPECT_DEATH(device_->startReadBack(*values_, 17), "read back of 17 bytes");
    const auto other = buffer(32);
    EXPECT_DEATH(device_->copy(*other, 0, 20, *values_, 0), "copy of 20 bytes at 0 in a buffer of 16");
    EXPECT_DEATH(device_->copy(*values_, 8, 12, *other, 0), "copy of 12 bytes at 8 in a buffer of 16");
}

TEST_F(DeviceDeathTest, NestedTimersEndTheProgram) {
    device_->beginTimer(0);
    EXPECT_DEATH(device_->beginTimer(1), "begun inside another");
    device_->endTimer();
    EXPECT_DEATH(device_->endTimer(), "not begun");
}

TEST_F(DeviceTest, HealthyDeviceHasNoError) {
    EXPECT_TRUE(device_->status().has_value());
}

}  // namespace
}  // namespace spherule::compute

#include "compute/gl/egl_api.h"
#include "compute/gl/open_context.h"
#include "device_fixture.h"

namespace spherule::compute {
namespace {

TEST(DeviceChoice, SoftwareIsASoftwareRenderer) {
    const auto device = openDevice("software");
    ASSERT_TRUE(device.has_value()) << device.error().text();
    const auto& info = (*device)->info();
    EXPECT_EQ(info.kind, "software");
    EXPECT_NE(info.renderer.find("llvmpipe"), std::string::npos) << info.renderer;
    EXPECT_GE(info.maxBufferBytes, std::size_t{16} << 20U);
    EXPECT_TRUE(info.robust);
}

TEST(DeviceChoice, AutoPrefersGpuAndReportsReason) {
    const auto device = openDevice("auto");
    ASSERT_TRUE(device.has_value()) << device.error().text();
    const auto& info = (*device)->info();
    if (info.kind == "gpu") {
        EXPECT_NE(info.reason.find("GPU was found"), std::string::npos) << info.reason;
    } else {
        EXPECT_EQ(info.kind, "cpu");
        EXPECT_NE(info.reason.find("no GPU here computes"), std::string::npos) << info.reason;
    }
}

TEST(DeviceChoice, CpuSupportsAnyNumberOfThreads) {
    for (const auto& [choice, threads] : {std::pair{"cpu:1", ", 1 thread, "},
                                          {"cpu:3", ", 3 threads, "},
                                          {"cpu-double:2", ", 2 threads, double precision"}}) {
        const auto device = openDevice(choice);
        ASSERT_TRUE(device.has_value()) << device.error().text();
        EXPECT_EQ((*device)->info().kind, "cpu");
        EXPECT_NE((*device)->info().renderer.find(threads), std::string::npos) << (*device)->info().renderer;
    }
}

TEST(DeviceChoice, MissingGpuIsRefusedWithAdvice) {
    const auto device = openDevice("gpu:99");
    ASSERT_FALSE(device.has_value());
    EXPECT_EQ(device.error().kind, ErrorKind::NoDevice);
    EXPECT_EQ(device.error().where, "gpu:99");
    EXPECT_NE(device.error().message.find("--device cpu"), std::string::npos) << device.error().text();
}

TEST(DeviceChoice, UnknownDevicesAreRefusedWithTheChoices) {
    for (const auto* const choice : {"", "GPU", "gpux", "gpu:", "gpu:-1", "gpu:1x", "cuda", "gpu:99999999999", "cpu:0",
                                     "cpu:", "cpu:2x", "cpux", "cpu:257"}) {
        const auto device = openDevice(choice);
        ASSERT_FALSE(device.has_value()) << choice;
        EXPECT_EQ(device.error().kind, ErrorKind::Input) << choice;
        EXPECT_NE(device.error().message.find("cpu"), std::string::npos) << device.error().text();
    }
}

TEST(DeviceChoice, DevicesCanBeOpenedRepeatedly) {
    for (int round = 0; round < 10; ++round) EXPECT_TRUE(openDevice(support::testDevice()).has_value());
}

TEST(DeviceChoice, SoftwareIsSurfacelessWithoutEglDevices) {
    ASSERT_TRUE(gl::loadEgl().has_value());
    const auto opened = gl::openContext(gl::parseWish("software").value(), {});
    ASSERT_TRUE(opened.has_value()) << opened.error().text();
    EXPECT_EQ(opened->kind, "software");
    EXPECT_TRUE(opened->context->software());
    EXPECT_EQ(opened->context->display().name(), "EGL without a surface");
}

TEST(DeviceChoice, OnlyCompleteExtensionNamesMatch) {
    EXPECT_TRUE(gl::hasExtension("EGL_A EGL_B EGL_C", "EGL_B"));
    EXPECT_TRUE(gl::hasExtension("EGL_AB EGL_A", "EGL_A"));
    EXPECT_FALSE(gl::hasExtension("EGL_AB XEGL_A", "EGL_A"));
    EXPECT_FALSE(gl::hasExtension("", "EGL_A"));
}

}  // namespace
}  // namespace spherule::compute

#include "compute/gl/egl_api.h"
#include "compute/gl/open_context.h"
#include "compute/gl/visible_gpus.h"
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

TEST(DeviceChoice, MissingCudaDeviceIsRefusedWithAdvice) {
    const auto device = openDevice("gpu:cuda:99");
    ASSERT_FALSE(device.has_value());
    EXPECT_EQ(device.error().kind, ErrorKind::NoDevice);
    EXPECT_EQ(device.error().where, "gpu:cuda:99");
    EXPECT_NE(device.error().message.find("CUDA numbers here: "), std::string::npos) << device.error().text();
    EXPECT_NE(device.error().message.find("--device cpu"), std::string::npos) << device.error().text();
}

TEST(DeviceChoice, UnknownDevicesAreRefusedWithTheChoices) {
    for (const auto* const choice :
         {"", "GPU", "gpux", "gpu:", "gpu:-1", "gpu:1x", "cuda", "gpu:99999999999", "gpu:cuda",
          "gpu:cuda:", "gpu:cuda:1x", "cuda:0", "cpu:0", "cpu:", "cpu:2x", "cpux", "cpu:257"}) {
        const auto device = openDevice(choice);
        ASSERT_FALSE(device.has_value()) << choice;
        EXPECT_EQ(device.error().kind, ErrorKind::Input) << choice;
        EXPECT_NE(device.error().message.find("cpu"), std::string::npos) << device.error().text();
    }
}

// The order of EGL, which is not CUDA's, with NVIDIA's devices by their CUDA numbers. -1: a device without one.
std::vector<gl::EglDevice> hostWith(const std::vector<int>& cudaNumbers) {
    std::vector<gl::EglDevice> devices;
    const auto add = [&](gl::EglDeviceClass deviceClass) -> gl::EglDevice& {
        gl::EglDevice& device = devices.emplace_back();
        device.index = static_cast<unsigned>(devices.size() - 1);
        device.deviceClass = deviceClass;
        return device;
    };
    for (const int number : cudaNumbers) {
        gl::EglDevice& device = add(gl::EglDeviceClass::Cuda);
        if (number >= 0) device.cudaNumber = static_cast<unsigned>(number);
    }
    add(gl::EglDeviceClass::Drm);
    add(gl::EglDeviceClass::Software);
    return devices;
}

// Returns the places in hostWith(cudaNumbers) of the devices that the variable leaves, and whether there is a note.
std::pair<std::vector<unsigned>, bool> left(const std::vector<int>& cudaNumbers, const char* variable) {
    const auto host = hostWith(cudaNumbers);
    const gl::VisibleGpus gpus = gl::visibleGpus(host, variable);
    std::vector<unsigned> places;
    for (const auto* device : gpus.devices) places.push_back(device->index);
    return {places, !gpus.note.empty()};
}

TEST(DeviceChoice, CudasVariableChoosesAmongNvidiasDevices) {
    using Left = std::pair<std::vector<unsigned>, bool>;
    const std::vector<int> host{2, 0, 1};  // and another vendor's at 3
    EXPECT_EQ(left(host, nullptr), Left({0, 1, 2, 3}, false));
    EXPECT_EQ(left(host, "0,1,2"), Left({1, 2, 0, 3}, false));
    EXPECT_EQ(left(host, "2"), Left({0, 3}, true));
    EXPECT_EQ(left(host, " 1, 0"), Left({2, 1, 3}, true));
    EXPECT_EQ(left(host, "1,7,0"), Left({2, 3}, true));
    EXPECT_EQ(left(host, "1,-1,0"), Left({2, 3}, true));
    for (const char* const none : {"", "-1", "7", "NoDevFiles"}) EXPECT_EQ(left(host, none), Left({3}, true)) << none;
}

TEST(DeviceChoice, CudasVariableIsNotFollowedWithoutNumbers) {
    using Left = std::pair<std::vector<unsigned>, bool>;
    EXPECT_EQ(left({2, 0, 1}, "GPU-8932f937-d72c-4106-c12f-20bd9faed9f6"), Left({0, 1, 2, 3}, true));
    EXPECT_EQ(left({-1, -1}, "1"), Left({0, 1, 2}, false));
    EXPECT_EQ(left({}, "0"), Left({0}, false));
}

// A driver that follows the variable hides the other devices, and counts these from 0.
TEST(DeviceChoice, ADriverMayFollowCudasVariableItself) {
    using Left = std::pair<std::vector<unsigned>, bool>;
    EXPECT_EQ(left({-1, 1, -1, 0}, "3,2"), Left({3, 1, 4}, false));
    EXPECT_EQ(left({-1, 1, -1, 0}, ""), Left({4}, true));
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

#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "compute/device.h"

namespace spherule::compute {

// Kernel sources given in the test.
class MapSources final : public SourceSet {
  public:
    using Files = std::map<std::string, std::string, std::less<>>;
    MapSources(std::initializer_list<Files::value_type> files) : files_(files) {}

    [[nodiscard]] std::optional<std::string_view> find(std::string_view name) const override {
        const auto file = files_.find(name);
        if (file == files_.end()) return std::nullopt;
        return file->second;
    }

  private:
    Files files_;
};

// The head of every kernel of these tests. It follows the conventions of device.h, without the project's shaders.
inline const std::string kernelHead = R"(
layout(local_size_x = 64) in;
layout(location = 0) uniform uint phase;
layout(location = 1) uniform uint invocations;
uint self() { return gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u; }
)";

// Opens the device named by SPHERULE_TEST_DEVICE. The default is Mesa's software renderer, which runs everywhere.
inline std::unique_ptr<Device> openTestDevice() {
    const char* const named = std::getenv("SPHERULE_TEST_DEVICE");
    auto device = openDevice(named == nullptr ? "software" : named);
    if (!device) throw std::runtime_error(device.error().text());
    return std::move(*device);
}

class DeviceTest : public testing::Test {
  protected:
    std::unique_ptr<Buffer> buffer(std::size_t bytes) { return device_->createBuffer("test", bytes).value(); }

    std::unique_ptr<Buffer> buffer(const std::vector<std::uint32_t>& values) {
        auto result = buffer(values.size() * 4);
        device_->upload(*result, 0, std::as_bytes(std::span(values)));
        return result;
    }

    // Compiles a kernel from kernelHead and `body`.
    std::unique_ptr<Kernel> kernel(const std::string& body, std::span<const Define> defines = {}) {
        const MapSources sources{{"test.comp", kernelHead + body}};
        auto result = device_->createKernel(sources, "test.comp", defines);
        if (!result) throw std::runtime_error(result.error().text());
        return std::move(*result);
    }

    std::vector<std::uint32_t> contents(const Buffer& from) {
        std::vector<std::uint32_t> values(from.bytes() / 4);
        device_->download(from, 0, std::as_writable_bytes(std::span(values)));
        return values;
    }

    // Launches with the buffers at slots 0, 1, ...
    void launch(const Kernel& kernel, std::uint32_t count, std::vector<Buffer*> buffers, std::uint32_t phase = 0) {
        Launch launch;
        launch.kernel = &kernel;
        launch.buffers = buffers;
        launch.count = count;
        launch.phase = phase;
        device_->launch(launch);
    }

    std::unique_ptr<Device> device_ = openTestDevice();
};

}  // namespace spherule::compute

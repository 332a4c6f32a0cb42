#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "compute/device.h"
#include "map_sources.h"
#include "test_device.h"

namespace spherule::compute {

// The head of every kernel of these tests. It follows the conventions of device.h, without the project's shaders.
inline const std::string kernelHead = R"(
layout(local_size_x = 64) in;
layout(location = 0) uniform uint phase;
layout(location = 1) uniform uint invocations;
uint self() { return gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u; }
)";

using support::openTestDevice;

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

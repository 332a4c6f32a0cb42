// radv_statistics FILE...: compiles compute shaders (SPIR-V) with Mesa's driver RADV for the GPU that RADV_FORCE_FAMILY
// names, without a GPU. Prints one JSON object a line: file, renderer, seconds, and the compiler's statistics by name.
// A shader has storage buffers at the bindings 0 to 15, a uniform block at 16, and push constants of four bytes.
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <vulkan/vulkan.h>
#include <nlohmann/json.hpp>

#include "compute/device.h"

namespace {

void check(VkResult result, const char* what) {
    if (result != VK_SUCCESS) throw std::runtime_error(fmt::format("{} failed with VkResult {}", what, int{result}));
}

// Handles live as long as the process.
class Compiler {
  public:
    Compiler() {
        VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_1};
        VkInstanceCreateInfo create{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
        VkInstance instance = nullptr;
        check(vkCreateInstance(&create, nullptr, &instance), "vkCreateInstance");
        VkPhysicalDevice gpu = nullptr;
        std::uint32_t count = 1;
        vkEnumeratePhysicalDevices(instance, &count, &gpu);
        if (gpu == nullptr) throw std::runtime_error("no Vulkan device; install mesa-vulkan-drivers");
        VkPhysicalDeviceProperties properties{};
        vkGetPhysicalDeviceProperties(gpu, &properties);
        renderer_ = properties.deviceName;
        if (renderer_.find("RADV") == std::string::npos) {
            throw std::runtime_error(fmt::format(
                "the first Vulkan device is {}; VK_ICD_FILENAMES must name RADV's file radeon_icd.*.json", renderer_));
        }
        createDevice(gpu);
        createLayout();
        properties_ = load<PFN_vkGetPipelineExecutablePropertiesKHR>("vkGetPipelineExecutablePropertiesKHR");
        statistics_ = load<PFN_vkGetPipelineExecutableStatisticsKHR>("vkGetPipelineExecutableStatisticsKHR");
    }

    nlohmann::json compile(const std::string& file) {
        const std::vector<char> code = contents(file);
        const VkShaderModuleCreateInfo create{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                              .codeSize = code.size(),
                                              .pCode = reinterpret_cast<const std::uint32_t*>(code.data())};
        VkShaderModule module = nullptr;
        check(vkCreateShaderModule(device_, &create, nullptr, &module), "vkCreateShaderModule");
        const VkComputePipelineCreateInfo pipeline{
            .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
            .flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR,
            .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                      .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                      .module = module,
                      .pName = "main"},
            .layout = layout_};
        VkPipeline compiled = nullptr;
        const auto begin = std::chrono::steady_clock::now();
        check(vkCreateComputePipelines(device_, nullptr, 1, &pipeline, nullptr, &compiled), "vkCreateComputePipelines");
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
        nlohmann::json result{{"file", file}, {"renderer", renderer_}, {"seconds", seconds.count()}};
        result["statistics"] = statisticsOf(compiled);
        vkDestroyPipeline(device_, compiled, nullptr);
        vkDestroyShaderModule(device_, module, nullptr);
        return result;
    }

  private:
    void createDevice(VkPhysicalDevice gpu) {
        const float priority = 1;
        const VkDeviceQueueCreateInfo queue{
            .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
        VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR feature{
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
            .pipelineExecutableInfo = VK_TRUE};
        const char* const extension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
        const VkDeviceCreateInfo create{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                        .pNext = &feature,
                                        .queueCreateInfoCount = 1,
                                        .pQueueCreateInfos = &queue,
                                        .enabledExtensionCount = 1,
                                        .ppEnabledExtensionNames = &extension};
        check(vkCreateDevice(gpu, &create, nullptr, &device_), "vkCreateDevice");
    }

    void createLayout() {
        std::vector<VkDescriptorSetLayoutBinding> bindings;
        const auto bind = [&](VkDescriptorType type) {
            bindings.push_back({.binding = static_cast<std::uint32_t>(bindings.size()),
                                .descriptorType = type,
                                .descriptorCount = 1,
                                .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT});
        };
        for (std::size_t k = 0; k < spherule::compute::maxKernelBuffers; ++k) bind(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
        bind(VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
        const VkDescriptorSetLayoutCreateInfo create{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                     .bindingCount = static_cast<std::uint32_t>(bindings.size()),
                                                     .pBindings = bindings.data()};
        VkDescriptorSetLayout set = nullptr;
        check(vkCreateDescriptorSetLayout(device_, &create, nullptr, &set), "vkCreateDescriptorSetLayout");
        const VkPushConstantRange constants{.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT, .size = 4};
        const VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                                .setLayoutCount = 1,
                                                .pSetLayouts = &set,
                                                .pushConstantRangeCount = 1,
                                                .pPushConstantRanges = &constants};
        check(vkCreatePipelineLayout(device_, &layout, nullptr, &layout_), "vkCreatePipelineLayout");
    }

    template <typename Function>
    Function load(const char* name) const {
        const auto function = reinterpret_cast<Function>(vkGetDeviceProcAddr(device_, name));
        if (function == nullptr) throw std::runtime_error(fmt::format("{} is missing", name));
        return function;
    }

    static std::vector<char> contents(const std::string& file) {
        std::ifstream stream(file, std::ios::binary);
        if (!stream) throw std::runtime_error("cannot be read");
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    nlohmann::json statisticsOf(VkPipeline pipeline) const {
        const VkPipelineInfoKHR info{.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, .pipeline = pipeline};
        std::uint32_t executables = 0;
        check(properties_(device_, &info, &executables, nullptr), "vkGetPipelineExecutablePropertiesKHR");
        if (executables != 1) throw std::runtime_error(fmt::format("has {} executables instead of one", executables));
        const VkPipelineExecutableInfoKHR executable{.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR,
                                                     .pipeline = pipeline};
        std::uint32_t count = 0;
        check(statistics_(device_, &executable, &count, nullptr), "vkGetPipelineExecutableStatisticsKHR");
        std::vector<VkPipelineExecutableStatisticKHR> all(count, {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
        check(statistics_(device_, &executable, &count, all.data()), "vkGetPipelineExecutableStatisticsKHR");
        nlohmann::json result;
        for (const auto& one : all) {
            if (one.format == VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR) result[one.name] = one.value.u64;
        }
        return result;
    }

    std::string renderer_;
    VkDevice device_ = nullptr;
    VkPipelineLayout layout_ = nullptr;
    PFN_vkGetPipelineExecutablePropertiesKHR properties_ = nullptr;
    PFN_vkGetPipelineExecutableStatisticsKHR statistics_ = nullptr;
};

}  // namespace

int main(int count, char** arguments) {
    std::string doing = "RADV";
    try {
        Compiler compiler;
        for (int k = 1; k < count; ++k) {
            doing = arguments[k];
            fmt::print("{}\n", compiler.compile(doing).dump());
        }
    } catch (const std::exception& problem) {
        fmt::print(stderr, "radv_statistics: {}: {}\n", doing, problem.what());
        return 1;
    }
    return 0;
}

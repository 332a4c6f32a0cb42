#include "compute/gl/visible_gpus.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include <spdlog/fmt/fmt.h>

namespace spherule::compute::gl {
namespace {

constexpr std::string_view variableName = "CUDA_VISIBLE_DEVICES";

// Returns the numbers in `list` up to the first entry that is none; nullopt if that entry is a UUID.
std::optional<std::vector<unsigned>> numbersOf(std::string_view list) {
    std::vector<unsigned> numbers;
    while (true) {
        const auto end = std::min(list.find(','), list.size());
        std::string_view entry = list.substr(0, end);
        while (entry.starts_with(' ')) entry.remove_prefix(1);
        while (entry.ends_with(' ')) entry.remove_suffix(1);
        if (entry.starts_with("GPU-") || entry.starts_with("MIG-")) return std::nullopt;
        unsigned number = 0;
        const auto parsed = std::from_chars(entry.data(), entry.data() + entry.size(), number);
        if (parsed.ec != std::errc() || parsed.ptr != entry.data() + entry.size()) return numbers;
        numbers.push_back(number);
        if (end == list.size()) return numbers;
        list.remove_prefix(end + 1);
    }
}

}  // namespace

VisibleGpus visibleGpus(const std::vector<EglDevice>& devices, const char* variable) {
    VisibleGpus result;
    std::vector<const EglDevice*> numbered;  // NVIDIA's, with CUDA numbers
    std::vector<const EglDevice*> others;
    bool anyHidden = false;
    for (const EglDevice& device : devices) {
        if (device.software()) continue;
        result.devices.push_back(&device);
        if (device.deviceClass != EglDeviceClass::Cuda) {
            others.push_back(&device);
        } else if (device.cudaNumber) {
            numbered.push_back(&device);
        } else {
            anyHidden = true;
        }
    }
    if (variable == nullptr || numbered.empty()) return result;
    const auto wanted = numbersOf(variable);
    if (!wanted) {
        result.note =
            fmt::format("{}={} has no effect, because EGL knows no UUIDs; use gpu:cuda:N", variableName, variable);
        return result;
    }

    std::vector<const EglDevice*> visible;
    for (const unsigned number : *wanted) {
        const auto found = std::ranges::find(numbered, number, [](const auto* device) { return *device->cudaNumber; });
        if (found == numbered.end()) break;
        visible.push_back(*found);
    }
    if (visible.empty() && !wanted->empty() && anyHidden) {
        visible = numbered;
        std::ranges::stable_sort(visible, {}, [](const auto* device) { return *device->cudaNumber; });
    }
    if (visible.size() < numbered.size())
        result.note =
            fmt::format("{}={} leaves {} of {} NVIDIA GPUs", variableName, variable, visible.size(), numbered.size());
    result.devices = std::move(visible);
    result.devices.insert(result.devices.end(), others.begin(), others.end());
    return result;
}

}  // namespace spherule::compute::gl

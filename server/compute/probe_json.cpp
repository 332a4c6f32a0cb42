#include <nlohmann/json.hpp>

#include "compute/probe.h"

namespace spherule::compute {
namespace {

using Json = nlohmann::ordered_json;

Json jsonOf(const ProbeVendor& vendor) {
    return {{"file", vendor.file}, {"library", vendor.library}, {"problem", vendor.problem}};
}

Json jsonOf(const ProbeDevice& device) {
    return {{"choice", device.choice},   {"index", device.index},
            {"name", device.name},       {"extensions", device.extensions},
            {"drmFile", device.drmFile}, {"cudaNumber", device.cudaNumber ? Json(*device.cudaNumber) : Json(nullptr)},
            {"vendor", device.vendor},   {"renderer", device.renderer},
            {"problem", device.problem}};
}

Json jsonOf(const DeviceInfo& info) {
    return {{"kind", info.kind},       {"renderer", info.renderer}, {"vendor", info.vendor},
            {"version", info.version}, {"reason", info.reason},     {"robust", info.robust}};
}

Json jsonOf(const Limits& limits) {
    return {{"maxBufferBytes", limits.maxBufferBytes},
            {"storageBuffersPerKernel", limits.storageBuffersPerKernel},
            {"storageBindings", limits.storageBindings},
            {"uniformBlockBytes", limits.uniformBlockBytes},
            {"groupsX", limits.groupsX},
            {"groupsY", limits.groupsY},
            {"groupInvocations", limits.groupInvocations},
            {"sharedBytes", limits.sharedBytes},
            {"subgroups", limits.subgroups}};
}

template <class T>
Json jsonOf(const std::optional<T>& value) {
    return value ? jsonOf(*value) : Json(nullptr);
}

template <class T>
Json arrayOf(const std::vector<T>& values) {
    Json array = Json::array();
    for (const auto& value : values) array.push_back(jsonOf(value));
    return array;
}

}  // namespace

std::string probeJson(const Probe& probe) {
    const Json json = {{"choice", probe.choice},
                       {"chosen", jsonOf(probe.chosen)},
                       {"limits", jsonOf(probe.limits)},
                       {"problem", probe.problem},
                       {"hints", probe.hints},
                       {"devices", arrayOf(probe.devices)},
                       {"vendors", arrayOf(probe.vendors)},
                       {"clientExtensions", probe.clientExtensions}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace spherule::compute

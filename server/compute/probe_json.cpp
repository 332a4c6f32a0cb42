#include <boost/json.hpp>

#include "compute/probe.h"

namespace spherule::compute {
namespace {

namespace json = boost::json;

json::value jsonOf(const ProbeVendor& vendor) {
    return {{"file", vendor.file}, {"library", vendor.library}, {"problem", vendor.problem}};
}

json::value jsonOf(const ProbeDevice& device) {
    return {{"choice", device.choice},         {"index", device.index},     {"name", device.name},
            {"extensions", device.extensions}, {"drmFile", device.drmFile}, {"vendor", device.vendor},
            {"renderer", device.renderer},     {"problem", device.problem}};
}

json::value jsonOf(const DeviceInfo& info) {
    return {{"kind", info.kind},       {"renderer", info.renderer}, {"vendor", info.vendor},
            {"version", info.version}, {"reason", info.reason},     {"robust", info.robust}};
}

json::value jsonOf(const Limits& limits) {
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
json::value jsonOf(const std::optional<T>& value) {
    return value ? jsonOf(*value) : json::value(nullptr);
}

template <class T>
json::array arrayOf(const std::vector<T>& values) {
    json::array array;
    for (const auto& value : values) array.push_back(jsonOf(value));
    return array;
}

}  // namespace

std::string probeJson(const Probe& probe) {
    return json::serialize(json::object{{"choice", probe.choice},
                                        {"chosen", jsonOf(probe.chosen)},
                                        {"limits", jsonOf(probe.limits)},
                                        {"problem", probe.problem},
                                        {"hints", json::array(probe.hints.begin(), probe.hints.end())},
                                        {"devices", arrayOf(probe.devices)},
                                        {"vendors", arrayOf(probe.vendors)},
                                        {"clientExtensions", probe.clientExtensions}});
}

}  // namespace spherule::compute

#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scene/quality.h"
#include "scene/stiffness.h"
#include "sim/layout.h"
#include "sim/memory_needs.h"
#include "sim/plan.h"
#include "sim/traffic.h"

namespace spherule::sim {

namespace {

struct Row {
    Pass pass{};
    std::string_view kernel;
    std::uint32_t launches = 0;
    std::uint32_t items = 0;  // invocations; bundles, or groups or runs of cells, if a work group has one
    std::string when;
};

std::string whenOf(const LaunchSpec& launch) {
    if (launch.observing) return fmt::format("every {}th step", observedEvery);
    if (launch.pass == Pass::Statistics) return "on demand";
    if (!launch.launchRow) return "every substep";
    if (*launch.launchRow == LAUNCH_UNLISTED) return "without lists";
    if (*launch.launchRow == LAUNCH_MOVERS) return "with movers";
    if (*launch.launchRow >= LAUNCH_COLLECT && *launch.launchRow <= LAUNCH_FORGET) return "on rebuild of movers";
    return *launch.launchRow >= LAUNCH_LOST_SPHERES ? "if contacts are lost" : "on rebuild";
}

// Successive launches of one kernel become one row of the plan.
std::vector<Row> rowsOf(const Plan& plan) {
    std::vector<Row> rows;
    for (const auto* launches : {&plan.substep, &plan.newSubstep, &plan.statistics}) {
        for (const LaunchSpec& launch : *launches) {
            const std::string when = launches == &plan.newSubstep ? "new substep length" : whenOf(launch);
            if (rows.empty() || rows.back().kernel != launch.kernel || rows.back().when != when)
                rows.push_back({launch.pass, launch.kernel, 0, launch.count, when});
            ++rows.back().launches;
        }
    }
    return rows;
}

std::string cellsText(const Level& level) {
    return fmt::format("{} x {} x {} cells of {:.4g} m", level.cells.x, level.cells.y, level.cells.z, level.cellSize);
}

std::string gridText(const Plan& plan) {
    const Grid& grid = plan.grid;
    std::string text;
    for (const Level& level : std::span(grid.levels).first(grid.sizes())) {
        text += fmt::format("{:<11}{}", text.empty() ? "grid" : "", cellsText(level));
        if (grid.sizes() > 1) text += fmt::format(" for {} spheres of up to {:.4g} m,\n", level.spheres, level.largest);
    }
    text += fmt::format("{}pairs listed up to a gap of {:.4g} m\n", grid.sizes() > 1 ? std::string(11, ' ') : ", ",
                        grid.margin);
    if (grid.hasMovers)
        text += fmt::format("{:<11}{} for up to {} spheres that move while most sleep\n", "movers",
                            cellsText(grid.levels.back()), plan.mostMovers);
    return text;
}

// Lists the periodic axes, with their lengths and cells.
std::string periodsText(const Plan& plan) {
    std::string text;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(plan.periods[axis] > 0)) continue;
        text += fmt::format("{:<11}{} every {:.4g} m", text.empty() ? "periodic" : "", "XYZ"[axis], plan.periods[axis]);
        if (plan.features.has(Feature::Contacts))
            text += fmt::format(", cells of {:.4g} m", plan.grid.coarsest().widths[axis]);
        text += "\n";
    }
    return text;
}

// Describes the springs of `accurate` and how finely the substeps resolve their contacts.
std::string contactText(const scene::Scene& scene) {
    const scene::ContactTime time = scene::contactTimeOf(scene);
    const double substep = scene.step / scene.quality.substeps;
    const double modulus = scene::springModulus(scene);
    const std::string model =
        modulus > 0 ? fmt::format("linear springs, k = 2 R* x {:.3g} Pa", modulus) : std::string("Hertz and Mindlin");
    return fmt::format("contacts   {}\n           at least {:.3g} s at {:.3g} m/s, {:.3g} substeps of {:.3g} s\n",
                       model, time.contact, time.speed, time.contact / substep, substep);
}

// One line per kernel.
std::string trafficText(const Plan& plan) {
    std::string text =
        fmt::format("\n{:<43}{:>9}{:>13}\n", "bytes per sphere, in a bed without sleep", "read", "written");
    double read = 0;
    double written = 0;
    const std::vector<Traffic> rows = trafficOf(plan, bedMeansOf(plan.model));
    if (rows.empty()) return {};
    for (auto row = rows.begin(); row != rows.end();) {
        const std::string_view kernel = row->kernel;
        double readHere = 0;
        double writtenHere = 0;
        for (; row != rows.end() && row->kernel == kernel; ++row) {
            readHere += row->read;
            writtenHere += row->written;
        }
        text += fmt::format("{:<43}{:>9.0f}{:>13.0f}\n", kernel, readHere, writtenHere);
        read += readHere;
        written += writtenHere;
    }
    return text + fmt::format("{:<43}{:>9.0f}{:>13.0f}\n", "all", read, written);
}

double perSphere(const Plan& plan, std::uint64_t bytes) {
    return plan.spheres == 0 ? 0.0 : static_cast<double>(bytes) / plan.spheres;
}

std::vector<MemoryPart> memoryOf(const Plan& plan, std::span<const MemoryPart> more) {
    std::vector<MemoryPart> parts = memoryNeedsOf(plan).parts();
    parts.insert(parts.end(), more.begin(), more.end());
    return parts;
}

}  // namespace

std::string planText(const scene::Scene& scene, const Plan& plan, std::span<const MemoryPart> more) {
    std::string text =
        fmt::format("scene      {}\nspheres    {}\nstep       {:g} s in {} substeps\nquality    {}\n", scene.name,
                    plan.spheres, scene.step, scene.quality.substeps, scene::nameOf(plan.model));
    text += "features  ";
    std::string_view comma = " ";
    for (const Feature feature : allFeatures()) {
        if (!plan.features.has(feature)) continue;
        text += fmt::format("{}{}", comma, nameOf(feature));
        comma = ", ";
    }
    text += "\n";
    if (plan.features.has(Feature::Contacts)) text += gridText(plan);
    text += periodsText(plan);
    if (plan.model == scene::Model::Accurate) text += contactText(scene);
    text += fmt::format("\n{:<16}{:>14}{:>16}\n", "array", "bytes", "bytes/sphere");
    for (const ArraySpec& spec : plan.arrays)
        text += fmt::format("{:<16}{:>14}{:>16.1f}\n", nameOf(spec.array), spec.bytes, perSphere(plan, spec.bytes));
    text += fmt::format("{:<16}{:>14}{:>16.1f}\n", "all", plan.bytes(), perSphere(plan, plan.bytes()));
    text += fmt::format("\n{:<36}{:>14}{:>16}\n", "memory", "bytes", "bytes/sphere");
    for (const MemoryPart& part : memoryOf(plan, more))
        text += fmt::format("{:<36}{:>14}{:>16.1f}\n", part.name, part.bytes, perSphere(plan, part.bytes));
    text += fmt::format("\n{:<17}{:<26}{:>9}{:>13}  {}\n", "pass", "kernel", "launches", "items", "when");
    for (const Row& row : rowsOf(plan))
        text += fmt::format("{:<17}{:<26}{:>9}{:>13}  {}\n", nameOf(row.pass), row.kernel, row.launches, row.items,
                            row.when);
    const SubstepCost usual = costOf(plan, false);
    const SubstepCost rebuilding = costOf(plan, true);
    text += fmt::format("\n{:<43}{:>9}{:>13}\n", "substep", "launches", "barriers");
    text += fmt::format("{:<43}{:>9}{:>13}\n", "without a rebuild of the lists", usual.launches, usual.barriers);
    if (mostBatches(plan) > 0) {
        text += fmt::format("{:<43}{:>9}{:>13}\n", "in which lists may be rebuilt", rebuilding.launches,
                            rebuilding.barriers);
        text += fmt::format("{:<43}{:>9}\n", "batches of pairs, one after another, at most", mostBatches(plan));
    }
    return text + trafficText(plan);
}

std::string planJson(const scene::Scene& scene, const Plan& plan, std::span<const MemoryPart> more) {
    nlohmann::ordered_json json;
    json["scene"] = scene.name;
    json["spheres"] = plan.spheres;
    json["step"] = scene.step;
    json["substepsPerStep"] = scene.quality.substeps;
    json["quality"] = scene::nameOf(plan.model);
    for (const Feature feature : allFeatures())
        json["features"][std::string(nameOf(feature))] = plan.features.has(feature);
    json["periods"] = {plan.periods.x, plan.periods.y, plan.periods.z};
    const Level& coarsest = plan.grid.coarsest();
    json["cells"] = {coarsest.cells.x, coarsest.cells.y, coarsest.cells.z};
    json["cellSize"] = static_cast<double>(coarsest.cellSize);
    json["levels"] = nlohmann::ordered_json::array();
    for (const Level& level : std::span(plan.grid.levels).first(plan.grid.sizes()))
        json["levels"].push_back({{"cells", {level.cells.x, level.cells.y, level.cells.z}},
                                  {"cellSize", static_cast<double>(level.cellSize)},
                                  {"spheres", level.spheres}});
    json["margin"] = static_cast<double>(plan.grid.margin);
    if (plan.model == scene::Model::Accurate) {
        const scene::ContactTime time = scene::contactTimeOf(scene);
        json["contact"] = {{"seconds", time.contact},
                           {"speed", time.speed},
                           {"substeps", time.contact * scene.quality.substeps / scene.step},
                           {"springModulus", scene::springModulus(scene)}};
    }
    json["arrays"] = nlohmann::ordered_json::array();
    for (const ArraySpec& spec : plan.arrays)
        json["arrays"].push_back({{"name", nameOf(spec.array)}, {"bytes", spec.bytes}});
    json["bytes"] = plan.bytes();
    json["bytesPerSphere"] = perSphere(plan, plan.bytes());
    json["memory"] = nlohmann::ordered_json::array();
    for (const MemoryPart& part : memoryOf(plan, more))
        json["memory"].push_back({{"name", part.name}, {"bytes", part.bytes}});
    json["passes"] = nlohmann::ordered_json::array();
    for (const Row& row : rowsOf(plan))
        json["passes"].push_back({{"pass", nameOf(row.pass)},
                                  {"kernel", row.kernel},
                                  {"launches", row.launches},
                                  {"items", row.items},
                                  {"when", row.when}});
    const auto costJson = [&](bool rebuild) {
        const SubstepCost cost = costOf(plan, rebuild);
        return nlohmann::ordered_json{{"launches", cost.launches}, {"barriers", cost.barriers}};
    };
    json["substep"] = costJson(false);
    json["rebuildSubstep"] = costJson(true);
    json["mostBatches"] = mostBatches(plan);
    json["traffic"] = nlohmann::ordered_json::array();
    for (const Traffic& row : trafficOf(plan, bedMeansOf(plan.model)))
        json["traffic"].push_back(
            {{"kernel", row.kernel}, {"array", nameOf(row.array)}, {"read", row.read}, {"written", row.written}});
    return json.dump();
}

}  // namespace spherule::sim

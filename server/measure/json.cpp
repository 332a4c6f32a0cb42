#include <fmt/format.h>

#include <string>

#include <nlohmann/json.hpp>

#include "measure/report.h"
#include "scene/quality.h"

namespace spherule::measure {

namespace {

using Json = nlohmann::ordered_json;

// Rounds to four digits: measured values are not more precise, and the file stays small.
double brief(double value) {
    return std::stod(fmt::format("{:.4g}", value));
}

// Returns the rung's entry in the list of its model; creates it if it is missing.
Json& entryOf(Json& models, const Rung& rung) {
    Json& rungs = models[std::string(scene::nameOf(rung.model))];
    if (rungs.is_null()) rungs = Json::array();
    for (Json& entry : rungs)
        if (entry["factor"] == rung.factor) return entry;
    rungs.push_back({{"factor", rung.factor}, {"curves", Json::object()}});
    return rungs.back();
}

}  // namespace

std::string jsonOf(const Report& report) {
    Json models = Json::object();
    Json verdicts = Json::array();
    for (const Outcome& outcome : report.outcomes) {
        for (const Figure& figure : outcome.figures) {
            if (!figure.curve.empty() && figure.error)
                entryOf(models, outcome.rung)["curves"][figure.curve] = {{"error", brief(*figure.error)},
                                                                         {"cost", brief(outcome.cost)},
                                                                         {"substep", brief(outcome.substep)},
                                                                         {"spheres", outcome.spheres}};
            if (!figure.verdict.empty())
                verdicts.push_back({{"case", outcome.name},
                                    {"figure", figure.name},
                                    {"model", scene::nameOf(outcome.rung.model)},
                                    {"factor", outcome.rung.factor},
                                    {"verdict", figure.verdict}});
        }
        if (!outcome.trouble.empty())
            verdicts.push_back({{"case", outcome.name},
                                {"figure", ""},
                                {"model", scene::nameOf(outcome.rung.model)},
                                {"factor", outcome.rung.factor},
                                {"verdict", "not measured: " + outcome.trouble}});
    }
    const Json whole = {{"device", report.device.kind},
                        {"renderer", report.device.renderer},
                        {"costUnit", "device seconds per simulated second"},
                        {"models", models},
                        {"verdicts", verdicts}};
    return whole.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace spherule::measure

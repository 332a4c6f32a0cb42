#include <fmt/format.h>
#include <array>

#include "cli/errors.h"
#include "cli/exit_codes.h"
#include "cli/options.h"
#include "codec/columns.h"
#include "encode/column_encoder.h"
#include "scene/catalog.h"
#include "sim/plan.h"

namespace spherule::cli {

namespace {

struct PlanOptions {
    std::string scene{scene::defaultScene};
    std::string kind = "gpu";
    scene::Overrides overrides;
    bool json = false;
};

int plan(const PlanOptions& options) {
    const auto loaded = scene::load(options.scene, options.kind, options.overrides);
    if (!loaded) return printError(loaded.error());
    const auto plan = sim::planFor(*loaded, sim::featuresOf(*loaded),
                                   static_cast<std::uint32_t>(loaded->spheres.size()), sim::radiusStatsOf(*loaded));
    if (plan.features.has(sim::Feature::Contacts))
        if (const auto fits = sim::checkPeriods(loaded->bounds, plan.grid); !fits) return printError(fits.error());
    const encode::EncoderBytes encoder = encode::encoderBytes(plan.spheres);
    const std::array more = {
        sim::MemoryPart{"device: order, if watched", encoder.contextArrays},
        sim::MemoryPart{"host: order, if watched", encoder.order},
        sim::MemoryPart{"device: each tier that is watched", codec::columnCount * encoder.encoderArrays},
        sim::MemoryPart{"host: each tier that is watched", codec::columnCount * encoder.frames}};
    fmt::print("{}\n", options.json ? sim::planJson(*loaded, plan, more) : sim::planText(*loaded, plan, more));
    return exitDone;
}

}  // namespace

void addPlan(CLI::App& app, int& exitCode) {
    auto options = std::make_shared<PlanOptions>();
    CLI::App* command = app.add_subcommand("plan", "show the arrays, passes and memory of a scene; needs no device");
    command->add_option("scene", options->scene, "a scene file or a name")->capture_default_str();
    command->add_option("--device", options->kind, "the kind of device to plan for: gpu, cpu or software")
        ->check(CLI::IsMember({"gpu", "cpu", "software"}))
        ->capture_default_str();
    addQuality(*command, options->overrides);
    command->add_option("--seed", options->overrides.seed, "seed, in place of the scene's seeds");
    command->add_flag("--no-sleep", options->overrides.noSleep, "put no sphere to sleep");
    command->add_flag("--contact-sums", options->overrides.contactSums,
                      "measure stress, dissipated energy and collisions");
    command->add_flag("--json", options->json, "print one line of JSON");
    command->callback([options, &exitCode] { exitCode = plan(*options); });
}

}  // namespace spherule::cli

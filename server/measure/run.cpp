#include <array>
#include <span>

#include <fmt/format.h>

#include "measure/cases.h"
#include "measure/report.h"
#include "scene/quality.h"

namespace spherule::measure {

namespace {

constexpr std::array<double, 5> fullFactors = {0.25, 0.5, 1, 2, 4};
constexpr std::array<double, 5> fastFactors = {0.5, 1, 2, 4, 8};  // `fast` chooses two substeps a step
constexpr std::array<double, 3> quickFactors = {0.5, 1, 2};
constexpr std::array<double, 1> ownFactor = {1};

std::span<const double> factorsOf(const Case& item, scene::Model model, bool quick) {
    if (!item.everyRung) return ownFactor;
    if (quick) return quickFactors;
    return model == scene::Model::Fast ? fastFactors : fullFactors;
}

}  // namespace

std::string nameOf(const Rung& rung) {
    return fmt::format("{} x{:g}", scene::nameOf(rung.model), rung.factor);
}

std::vector<Case> casesOf(const std::string& suite) {
    std::vector<Case> chosen;
    for (const auto& family : {flightCases(), impactCases(), hertzCases(), frictionCases(), chainCases(), gasCases(),
                               restCases(), reposeCases(), extremeCases(), settingCases(), commandCases(),
                               featureCostCases(), bedCostCases(), crowdCases()})
        for (const Case& item : family)
            if (suite == "all" || suite == item.suite) chosen.push_back(item);
    return chosen;
}

Result<Report> measure(compute::Device& device, const Options& options, const Progress& progress) {
    Report report;
    report.device = device.info();
    for (const Case& item : casesOf(options.suite)) {
        if (options.quick && !item.whenQuick) continue;
        for (const scene::Model model : {scene::Model::Fast, scene::Model::Balanced, scene::Model::Accurate}) {
            if (!item.everyModel && model != scene::Model::Accurate) continue;
            for (const double factor : factorsOf(item, model, options.quick)) {
                const Rung rung{model, factor};
                progress(fmt::format("{}: {}, {}", item.suite, item.name, nameOf(rung)));
                Bench bench(device, rung, options.quick);
                const auto done = item.run(bench);
                if (auto alive = device.status(); !alive) return tl::unexpected(alive.error());
                Outcome outcome = bench.finish();
                outcome.suite = item.suite;
                outcome.name = item.name;
                if (!done) outcome.trouble = done.error().text();
                report.outcomes.push_back(std::move(outcome));
            }
        }
    }
    return report;
}

}  // namespace spherule::measure

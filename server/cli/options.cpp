#include "cli/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "cli/option_values.h"
#include "core/memory.h"
#include "core/quantity.h"
#include "scene/quality.h"
#include "scene/quality_goal.h"

namespace spherule::cli {

namespace {

// Parses a goal such as "16ms" or "0.5%"; nullopt if it is invalid.
std::optional<scene::QualityGoal> goalFrom(const std::string& words) {
    const auto given = quantityOf(words);
    if (!given) return std::nullopt;
    v1::Auto message;
    if (given->unit == "ms") message.set_budget_ms(given->number);
    if (given->unit == "%") message.set_overlap(given->number / 100);
    const auto goal = scene::qualityGoalOf(message, "");
    return goal ? *goal : std::nullopt;
}

}  // namespace

const CLI::Validator finiteRate(
    [](const std::string& words) {
        const auto given = quantityOf(words);
        return given && given->unit.empty() && given->number >= 0 ? "" : "'" + words + "' is no number of 0 or above";
    },
    "NUMBER");

void addQuality(CLI::App& command, scene::Overrides& overrides) {
    command
        .add_option_function<std::string>(
            "--quality", [&overrides](const std::string& name) { overrides.model = scene::modelNamed(name); },
            "contact model, in place of the scene's")
        ->check(CLI::IsMember({"fast", "balanced", "accurate"}));
    command.add_option("--substeps", overrides.substeps, "substeps per step, in place of the scene's");
}

void addGoal(CLI::App& command, scene::Overrides& overrides) {
    command
        .add_option_function<std::string>(
            "--auto", [&overrides](const std::string& goal) { overrides.goal = goalFrom(goal); },
            "move the substeps to hold a wall time per step, such as 16ms, or a mean overlap, such as 0.5%")
        ->check([](const std::string& goal) {
            return goalFrom(goal) ? "" : "'" + goal + "' is neither a time such as 16ms nor an overlap such as 0.5%";
        });
}

void SceneOptions::addTo(CLI::App& command) {
    std::string known;
    for (const std::string& name : scene::names()) known += (known.empty() ? "" : ", ") + name;
    command.add_option("scene", scene, "a scene file, or one of: " + known)->capture_default_str();
    command.add_option("--device", device, "auto, gpu, gpu:N, gpu:cuda:N, cpu, cpu:THREADS or software")
        ->capture_default_str();
    addQuality(command, overrides);
    addGoal(command, overrides);
    command.add_option("--seed", overrides.seed, "seed, in place of the scene's seeds");
    command.add_flag("--no-sleep", overrides.noSleep, "put no sphere to sleep");
    command.add_flag("--contact-sums", overrides.contactSums, "measure stress, dissipated energy and collisions");
    command
        .add_option_function<std::uint64_t>(
            "--memory-limit", memory::setLimit,
            "largest memory of the program, such as 4GiB [the limit of the machine and its "
            "control groups]")
        ->transform(CLI::AsSizeValue(false));
}

void addWatchdog(CLI::App& command, double& seconds) {
    constexpr const char* name = "--watchdog";
    seconds = 60;
    command
        .add_option_function<std::string>(
            name, [&seconds](const std::string& time) { seconds = secondsOf(time, name).value_or(seconds); },
            "end with exit code 75 when no kernel has completed for this time; 0: never")
        ->check([](const std::string& time) {
            const auto given = secondsOf(time, name);
            return given ? "" : given.error().text();
        })
        ->default_str("60s");
}

}  // namespace spherule::cli

#include "app/options.h"

#include <fmt/format.h>

#include <cstdio>

#include "app/exit_codes.h"
#include "scene/quality.h"

namespace spherule::app {

void addQuality(CLI::App& command, scene::Overrides& overrides) {
    command
        .add_option_function<std::string>(
            "--quality", [&overrides](const std::string& name) { overrides.model = scene::modelNamed(name); },
            "fast, balanced or accurate, in place of the scene's")
        ->check(CLI::IsMember({"fast", "balanced", "accurate"}));
    command.add_option("--substeps", overrides.substeps, "per step, in place of the scene's");
}

void SceneOptions::addTo(CLI::App& command) {
    std::string known;
    for (const std::string& name : scene::names()) known += (known.empty() ? "" : ", ") + name;
    command.add_option("scene", scene, "a scene file, or one of: " + known)->capture_default_str();
    command.add_option("--device", device, "auto, gpu, gpu:N, cpu, cpu:THREADS or software")->capture_default_str();
    addQuality(command, overrides);
    command.add_option("--seed", overrides.seed, "in place of the scene's seeds");
    command.add_flag("--no-sleep", overrides.noSleep, "no sphere is put to sleep");
}

int report(const Error& error) {
    fmt::print(stderr, "spherule: {}\n", error.text());
    return exitCodeOf(error.kind);
}

}  // namespace spherule::app

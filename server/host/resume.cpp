#include "host/resume.h"

#include <cstdint>
#include <filesystem>

#include "core/heartbeat.h"
#include "core/input_file.h"
#include "core/log.h"
#include "core/text.h"
#include "scene/json.h"
#include "scene/load.h"
#include "spherule/v1/control.pb.h"

namespace spherule::host {

namespace {

// Returns the name that the scene would have. The file may be gone, or be wrong.
std::string nameOf(const std::string& asked) {
    constexpr std::uint64_t longestFile = 32U << 20U;  // bytes, as for scenes that are loaded
    if (!scene::isPath(asked)) return asked;
    const heartbeat::Pause reading;
    if (const auto text = readFile(asked, longestFile))
        if (const auto message = scene::parseJson(*text, asked); message && !message->name().empty())
            return message->name();
    return std::string(cutUtf8(utf8(std::filesystem::path(asked).stem().string()), scene::longestName));
}

}  // namespace

void reportResumed(const std::string& checkpoint, const sim::Simulation& simulation, const std::string& asked) {
    const std::string& name = simulation.scene().name;
    spdlog::info(
        "goes on from {} with the scene {}, at step {}, {:.6g} s simulated; the scene of the command line and its "
        "options are not used",
        checkpoint, name, simulation.steps(), simulation.time());
    if (const std::string other = nameOf(asked); other != name)
        spdlog::warn(
            "the checkpoint has the scene {}, the command line names the scene {}, which is not used; to begin with "
            "it, leave out --resume or give --checkpoints another folder",
            name, other);
}

void releasePulls(sim::Simulation& simulation, checkpoint::Keeper& keeper) {
    for (const std::uint64_t session : simulation.pullingSessions()) {
        v1::Command release;
        release.mutable_release();
        keeper.logCommand(checkpoint::placeOf(simulation), session, release);
        simulation.release(session);
    }
}

}  // namespace spherule::host

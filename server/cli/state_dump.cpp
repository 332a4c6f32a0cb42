#include "cli/state_dump.h"

#include <fmt/format.h>

#include <iterator>

#include "core/heartbeat.h"

namespace spherule::cli {

Result<StateDump> StateDump::create(const std::string& path, bool replace) {
    auto file = recording::OutputFile::create(path, replace);
    if (!file) return tl::unexpected(file.error());
    StateDump dump(std::move(*file));
    if (auto done = dump.file_.write("time,id,x,y,z,vx,vy,vz,radius\n"); !done) return tl::unexpected(done.error());
    return dump;
}

Result<void> StateDump::write(sim::Simulation& simulation) {
    const sim::State state = simulation.snapshot();
    const heartbeat::Pause writing;
    const glm::dvec3 centre = simulation.scene().bounds.centre();
    std::string text;
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const glm::dvec3 x = glm::dvec3(state.position[id]) + centre;
        const glm::vec4& v = state.velocity[id];
        fmt::format_to(std::back_inserter(text), "{:.9g},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n",
                       simulation.time(), id, x.x, x.y, x.z, v.x, v.y, v.z, state.position[id].w);
    }
    if (auto done = file_.write(text); !done) return done;
    auto done = file_.flush();
    if (done) file_.persist();
    return done;
}

}  // namespace spherule::cli

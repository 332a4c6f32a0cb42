#include "app/dump.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <iterator>

#include "core/pulse.h"

namespace spherule::app {

Result<Dump> Dump::create(const std::string& path) {
    Dump dump(path);
    dump.file_ << "time,id,x,y,z,vx,vy,vz,radius\n";
    if (!dump.file_) return fail(ErrorKind::Input, path, std::string("cannot be written: ") + std::strerror(errno));
    return dump;
}

Result<void> Dump::write(sim::Simulation& simulation) {
    const sim::State state = simulation.snapshot();
    const pulse::Unwatched writing;
    const glm::dvec3 centre = simulation.scene().bounds.centre();
    std::string text;
    for (std::uint32_t id = 0; id < state.count(); ++id) {
        const glm::dvec3 x = glm::dvec3(state.position[id]) + centre;
        const glm::vec4& v = state.velocity[id];
        fmt::format_to(std::back_inserter(text), "{:.9g},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n",
                       simulation.time(), id, x.x, x.y, x.z, v.x, v.y, v.z, state.position[id].w);
    }
    file_ << text << std::flush;
    if (!file_) return fail(ErrorKind::Input, path_, std::string("cannot be written: ") + std::strerror(errno));
    return {};
}

}  // namespace spherule::app

#include "cli/state_dump.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include "core/heartbeat.h"

namespace spherule::cli {

namespace {

// write() prints the values of a row in this order.
constexpr std::string_view header = "time,id,x,y,z,vx,vy,vz,radius,wx,wy,wz,material,group,asleep,contacts\n";

}  // namespace

Result<StateDump> StateDump::create(const std::string& path, bool replace) {
    auto file = recording::OutputFile::create(path, replace);
    if (!file) return tl::unexpected(file.error());
    StateDump dump(std::move(*file));
    if (auto done = dump.file_.write(header); !done) return tl::unexpected(done.error());
    return dump;
}

Result<void> StateDump::write(sim::Simulation& simulation) {
    const sim::State state = simulation.snapshot();
    const std::vector<std::uint32_t> contacts = simulation.contactCounts();
    const heartbeat::Pause writing;
    const scene::Scene& scene = simulation.scene();
    const glm::dvec3 centre = scene.bounds.centre();
    constexpr std::size_t part = 1U << 20U;  // bytes
    std::string text;
    for (std::uint32_t rank = 0; rank < state.count(); ++rank) {
        const glm::dvec3 x = glm::dvec3(state.position[rank]) + centre;
        const glm::vec4& v = state.velocity[rank];
        const glm::vec4& w = state.spin[rank];
        fmt::format_to(std::back_inserter(text),
                       "{:.9g},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{},{},{},{}\n",
                       simulation.time(), state.idAt(rank), x.x, x.y, x.z, v.x, v.y, v.z, state.position[rank].w, w.x,
                       w.y, w.z, scene.spheres[rank].material, scene.spheres[rank].group, std::signbit(v.w) ? 1 : 0,
                       contacts[rank]);
        if (text.size() < part) continue;
        if (auto done = file_.write(text); !done) return done;
        text.clear();
    }
    if (auto done = file_.write(text); !done) return done;
    auto done = file_.flush();
    if (done) file_.persist();
    return done;
}

}  // namespace spherule::cli

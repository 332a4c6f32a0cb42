#include "cli/force_table.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "core/heartbeat.h"

namespace spherule::cli {

Result<ForceTable> ForceTable::create(const std::string& path, bool replace) {
    auto file = recording::OutputFile::create(path, replace);
    if (!file) return tl::unexpected(file.error());
    ForceTable table(std::move(*file));
    if (auto done = table.file_.write("time,surface,fx,fy,fz,tx,ty,tz\n"); !done) return tl::unexpected(done.error());
    return table;
}

Result<void> ForceTable::write(sim::Simulation& simulation) {
    const sim::ContactSums sums = simulation.readContactSums();
    const auto forces = sim::meanForces(sums.since(std::exchange(before_, sums)), simulation.scene());
    const heartbeat::Pause writing;
    std::string text;
    for (const auto& [surface, force, torque] : forces)
        fmt::format_to(std::back_inserter(text), "{:.9g},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n",
                       simulation.time(), surface, force.x, force.y, force.z, torque.x, torque.y, torque.z);
    auto done = file_.write(text);
    if (done) done = file_.flush();
    if (done) file_.persist();
    return done;
}

}  // namespace spherule::cli

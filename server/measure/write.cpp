#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "measure/report.h"

namespace spherule::measure {

namespace {

Result<void> writeFile(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text << std::flush;
    if (!file) return fail(ErrorKind::Input, path.string(), std::string("cannot be written: ") + std::strerror(errno));
    return {};
}

}  // namespace

Result<void> checkFolder(const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return fail(ErrorKind::Input, folder, "cannot be made: " + error.message());
    // Test whether files can be written by writing one, which is replaced at the end.
    return writeFile(std::filesystem::path(folder) / "measure.csv", "");
}

Result<void> write(const Report& report, const std::string& folder) {
    const std::filesystem::path base(folder);
    if (auto done = writeFile(base / "measure.csv", csvOf(report)); !done) return done;
    if (auto done = writeFile(base / "measure.md", markdownOf(report)); !done) return done;
    if (auto done = writeFile(base / "measure.json", jsonOf(report)); !done) return done;
    for (Plot& plot : plotsOf(report)) {
        std::ranges::replace(plot.name, ' ', '-');
        if (auto done = writeFile(base / (plot.name + ".svg"), plot.svg); !done) return done;
    }
    return {};
}

}  // namespace spherule::measure

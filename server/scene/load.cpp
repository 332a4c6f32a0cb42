#include "scene/load.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>

#include "core/heartbeat.h"
#include "core/input_file.h"
#include "core/text.h"
#include "scene/build.h"
#include "scene/catalog.h"
#include "scene/check.h"
#include "scene/json.h"

namespace spherule::scene {

namespace {

bool isPath(std::string_view source) {
    return source.find('/') != std::string_view::npos || source.ends_with(".json");
}

constexpr std::uint64_t longestFile = 32U << 20U;  // bytes of JSON
constexpr std::ptrdiff_t mostObjects = 2'000'000;  // each takes about 130 bytes when parsed, even if empty

Result<Scene> buildText(const std::string& text, const std::string& source, const std::string& name,
                        const std::optional<std::filesystem::path>& directory, const Overrides& overrides,
                        Progress* progress) {
    auto message = parseJson(text, source);
    if (!message) return tl::unexpected(message.error());
    if (message->name().empty()) message->set_name(std::string(cutUtf8(utf8(name), longestName)));
    return buildIn(directory, *message, overrides, progress).map_error([&](Error error) {
        error.where = fmt::format("{}: {}", source, error.where);
        return error;
    });
}

}  // namespace

Result<Scene> load(const std::string& source, std::string_view deviceKind, const Overrides& overrides,
                   Progress* progress) {
    if (isPath(source)) {
        const heartbeat::Pause reading;
        const std::filesystem::path path(source);
        auto text = readFile(source, longestFile);
        if (!text) return tl::unexpected(text.error());
        dropByteOrderMark(*text);
        if (const auto objects = std::count(text->begin(), text->end(), '{'); objects > mostObjects)
            return fail(ErrorKind::Input, source,
                        fmt::format("has {} objects, at most {} are allowed; give so many spheres as csv, xyz, lammps, "
                                    "lattice or fill",
                                    objects, mostObjects));
        return buildText(*text, source, path.stem().string(), path.parent_path(), overrides, progress);
    }
    if (const auto text = embeddedScene(source, deviceKind)) {
        return buildText(std::string(*text), source, source, std::nullopt, overrides, progress);
    }
    return fail(ErrorKind::Input, shown(source),
                fmt::format("is not the name of a scene; there are {}. A file is named with its ending, .json",
                            fmt::join(names(), ", ")));
}

}  // namespace spherule::scene

#include "scene/load.h"

#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/pulse.h"
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

Result<std::string> readFile(const std::filesystem::path& path) {
    std::error_code error;
    const bool exists = std::filesystem::exists(path, error);
    if (!exists) return fail(ErrorKind::Input, path.string(), "there is no such file");
    std::ifstream file(path, std::ios::binary);
    if (!std::filesystem::is_regular_file(path, error) || !file) {
        return fail(ErrorKind::Input, path.string(), "cannot be read as a file");
    }
    return std::string(std::istreambuf_iterator<char>(file), {});
}

Result<Scene> buildText(const std::string& text, const std::string& source, const std::string& name,
                        const std::optional<std::filesystem::path>& directory, const Overrides& overrides) {
    auto message = parseJson(text, source);
    if (!message) return tl::unexpected(message.error());
    if (message->name().empty()) message->set_name(std::string(cutUtf8(utf8(name), longestName)));
    return buildIn(directory, *message, overrides).map_error([&](Error error) {
        error.where = fmt::format("{}: {}", source, error.where);
        return error;
    });
}

}  // namespace

Result<Scene> load(const std::string& source, std::string_view deviceKind, const Overrides& overrides) {
    if (isPath(source)) {
        const pulse::Unwatched reading;
        const std::filesystem::path path(source);
        const auto text = readFile(path);
        if (!text) return tl::unexpected(text.error());
        return buildText(*text, source, path.stem().string(), path.parent_path(), overrides);
    }
    if (const auto text = embeddedScene(source, deviceKind)) {
        return buildText(std::string(*text), source, source, std::nullopt, overrides);
    }
    return fail(ErrorKind::Input, shown(source),
                fmt::format("is not the name of a scene; there are {}. A file is named with its ending, .json",
                            fmt::join(names(), ", ")));
}

}  // namespace spherule::scene

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
#include "scene/structure.h"

namespace spherule::scene {

namespace {

constexpr std::uint64_t longestFile = 32U << 20U;  // bytes of JSON
constexpr std::ptrdiff_t mostObjects = 2'000'000;  // each takes about 130 bytes when parsed, even if empty

// The place of a mistake: "file:line:column: field.path".
std::string placeOf(const std::string& source, const std::string& lineAndColumn, const std::string& path) {
    return fmt::format("{}{}{}{}", source, lineAndColumn, path.empty() ? "" : ": ", path);
}

Result<std::string> readUnpaused(const std::string& source) {
    auto text = readFile(source, longestFile);
    if (!text) return text;
    dropByteOrderMark(*text);
    if (const auto objects = std::count(text->begin(), text->end(), '{'); objects > mostObjects)
        return fail(ErrorKind::Input, source,
                    fmt::format("has {} objects, at most {} are allowed; give so many spheres as csv, xyz, lammps, "
                                "lattice or fill",
                                objects, mostObjects));
    return text;
}

Result<std::string> readText(const std::string& source) {
    const heartbeat::Pause reading;
    return readUnpaused(source);
}

// `mistakes`: in the order of their places.
std::vector<Error> errorsOf(const std::vector<Mistake>& mistakes, const std::string& text, const std::string& source) {
    std::vector<Error> errors;
    LineCounter lines(text);
    for (const Mistake& one : mistakes)
        errors.push_back({ErrorKind::Input, placeOf(source, lines.at(one.offset), one.path), one.message});
    return errors;
}

std::vector<Error> structuralErrors(const std::string& text, const std::string& source) {
    return errorsOf(structureOf(text).mistakes, text, source);
}

std::size_t offsetOf(const std::string& text, const std::string& path) {
    TextPlaces places;
    places.add(path);
    find(places, text);
    return places.offsetOf(path);
}

// Builds a scene from a text without structural mistakes.
Result<Scene> buildText(const std::string& text, const std::string& source, const std::string& name,
                        const std::optional<std::filesystem::path>& directory, const Overrides& overrides,
                        Progress* progress) {
    auto message = parseJson(text, source);
    const auto withPlace = [&](Error error) {
        error.where = placeOf(source, lineAndColumn(text, offsetOf(text, error.where)), error.where);
        return error;
    };
    if (!message) {
        const std::string prefix = source + ": ";
        Error error = message.error();
        if (!error.where.starts_with(prefix)) return tl::unexpected(error);
        error.where.erase(0, prefix.size());
        return tl::unexpected(withPlace(error));
    }
    if (message->name().empty()) message->set_name(std::string(cutUtf8(utf8(name), longestName)));
    return buildIn(directory, *message, overrides, progress).map_error(withPlace);
}

Result<Scene> buildFile(const std::string& text, const std::string& source, const Overrides& overrides,
                        Progress* progress) {
    const std::filesystem::path path(source);
    return buildText(text, source, path.stem().string(), path.parent_path(), overrides, progress);
}

// Returns the errors of a scene's content, as far as the text can be read. Each has the path of its field.
std::vector<Error> contentErrors(const std::string& text, const std::string& source, const Structure& structure) {
    const auto message = parseJson(structure.cuts.empty() ? text : withoutCuts(text, structure.cuts), source);
    if (!message) {
        const std::string prefix = source + ": ";
        Error error = message.error();
        error.where = error.where.starts_with(prefix) ? error.where.substr(prefix.size()) : "";
        return {error};
    }
    std::vector<std::string> doubts;
    for (const Mistake& one : structure.mistakes) doubts.push_back(one.meant.empty() ? one.path : one.meant);
    return errorsIn(std::filesystem::path(source).parent_path(), *message, std::move(doubts));
}

// Adds the mistakes of the content to the structural ones.
void addContent(std::vector<Mistake>& mistakes, const std::string& text, std::vector<Error> errors) {
    TextPlaces places;
    for (const Error& error : errors) places.add(error.where);
    find(places, text);
    for (Error& error : errors)
        mistakes.push_back({places.offsetOf(error.where), std::move(error.where), std::move(error.message), ""});
    std::ranges::stable_sort(mistakes, {}, &Mistake::offset);
    mistakes.resize(std::min(mistakes.size(), mostMistakes));
}

// Adds the values of all fields `file` in a message.
void addFiles(const google::protobuf::Message& message, std::vector<std::string>& files) {
    const auto& reflection = *message.GetReflection();
    std::vector<const google::protobuf::FieldDescriptor*> fields;
    reflection.ListFields(message, &fields);
    for (const auto* const field : fields) {
        if (field->name() == "file" && field->cpp_type() == field->CPPTYPE_STRING && !field->is_repeated())
            files.push_back(reflection.GetString(message, field));
        if (field->cpp_type() != field->CPPTYPE_MESSAGE) continue;
        if (!field->is_repeated()) addFiles(reflection.GetMessage(message, field), files);
        for (int k = 0; field->is_repeated() && k < reflection.FieldSize(message, field); ++k)
            addFiles(reflection.GetRepeatedMessage(message, field, k), files);
    }
}

}  // namespace

bool isPath(std::string_view source) {
    return source.find('/') != std::string_view::npos || source.ends_with(".json");
}

Result<Scene> load(const std::string& source, std::string_view deviceKind, const Overrides& overrides,
                   Progress* progress) {
    if (isPath(source)) {
        const auto text = readText(source);
        if (!text) return tl::unexpected(text.error());
        std::vector<Error> errors = structuralErrors(*text, source);
        if (errors.empty()) return buildFile(*text, source, overrides, progress);
        if (errors.size() > 1)
            errors[0].message += fmt::format(" ({} more: see `spherule scene check`)", errors.size() - 1);
        return tl::unexpected(errors[0]);
    }
    if (const auto text = embeddedScene(source, deviceKind)) {
        return buildText(std::string(*text), source, source, std::nullopt, overrides, progress);
    }
    return fail(ErrorKind::Input, shown(source),
                fmt::format("is not the name of a scene; there are {}. A file is named with its ending, .json",
                            fmt::join(names(), ", ")));
}

std::vector<Error> structuralMistakesOf(const std::string& path) {
    const auto text = readText(path);
    if (!text) return {text.error()};
    return structuralErrors(*text, path);
}

Result<std::vector<std::string>> filesNamedIn(const std::string& path) {
    const auto text = readUnpaused(path);
    if (!text) return tl::unexpected(text.error());
    const auto message = parseJson(*text, path);
    if (!message) return tl::unexpected(message.error());
    std::vector<std::string> files;
    addFiles(*message, files);
    for (std::string& file : files) file = (std::filesystem::path(path).parent_path() / file).string();
    return files;
}

std::vector<Error> mistakesOf(const std::string& path) {
    const auto text = readText(path);
    if (!text) return {text.error()};
    Structure structure = structureOf(*text);
    const auto isNoScene = [](const Mistake& one) { return one.path.empty(); };
    if (structure.wholeRead && std::ranges::none_of(structure.mistakes, isNoScene))
        addContent(structure.mistakes, *text, contentErrors(*text, path, structure));
    return errorsOf(structure.mistakes, *text, path);
}

}  // namespace spherule::scene

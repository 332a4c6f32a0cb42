#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/errors.h"
#include "cli/exit_codes.h"
#include "cli/options.h"
#include "core/suggestion.h"
#include "core/text.h"
#include "embedded/sceneTemplates.h"
#include "recording/output_file.h"
#include "scene/field_tables.h"
#include "scene/json_schema.h"

namespace spherule::cli {

namespace {

constexpr std::string_view suffix = ".json";

std::string nameOf(const embedded::File& file) {
    return std::string(file.path.substr(0, file.path.size() - suffix.size()));
}

int check(const std::vector<std::string>& files) {
    int code = exitDone;
    for (const std::string& file : files) {
        const std::vector<Error> errors = scene::mistakesOf(file);
        for (const Error& error : errors) fmt::print("{}\n", withoutControls(error.text()));
        if (errors.empty()) fmt::print("{}: no mistakes\n", withoutControls(file));
        if (!errors.empty()) code = std::max(code, exitCodeOf(errors.front().kind));
    }
    return code;
}

int fields(const std::vector<std::string>& messages) {
    const Result<std::string> table = messages.empty() ? scene::fieldTables() : scene::fieldTable(messages);
    if (!table) return printError(table.error());
    fmt::print("{}", *table);
    return exitDone;
}

void listTemplates() {
    for (const embedded::File& file : embedded::sceneTemplates())
        fmt::print("{:8} {}\n", nameOf(file), nlohmann::json::parse(file.bytes).value("description", ""));
}

Result<void> writeNew(const std::string& name, const std::string& path) {
    const auto files = embedded::sceneTemplates();
    const auto found = std::ranges::find(files, name, nameOf);
    if (found == files.end()) {
        std::vector<std::string> names;
        for (const embedded::File& file : files) names.push_back(nameOf(file));
        const auto nearest = suggestionFor(name, names);
        return fail(ErrorKind::Input, fmt::format("\"{}\"", name),
                    fmt::format("is no template{}; there are {}",
                                nearest ? fmt::format(" (did you mean {}?)", *nearest) : "", fmt::join(names, ", ")));
    }
    if (std::filesystem::exists(path)) return fail(ErrorKind::Input, path, "is there already; give another name");
    auto file = recording::OutputFile::create(path, false);
    if (!file) return tl::unexpected(file.error());
    if (auto done = file->write(found->bytes); !done) return done;
    return file->close();
}

int create(const std::string& name, const std::string& path) {
    if (name.empty()) {
        listTemplates();
        return exitDone;
    }
    const std::string to = path.empty() ? name + std::string(suffix) : path;
    if (const auto done = writeNew(name, to); !done) return printError(done.error());
    fmt::print(
        "{}: written; `spherule scene schema > scene.schema.json` beside it lets editors complete and check it\n",
        withoutControls(to));
    return exitDone;
}

}  // namespace

void addScene(CLI::App& app, int& exitCode) {
    CLI::App* const command = app.add_subcommand("scene", "check, begin and describe scene files");
    command->require_subcommand(1);

    const auto files = std::make_shared<std::vector<std::string>>();
    CLI::App* const checking = command->add_subcommand("check", "list all mistakes of scene files with their places");
    checking->add_option("files", *files, "scene files")->required();
    checking->callback([files, &exitCode] { exitCode = check(*files); });

    const auto words = std::make_shared<std::pair<std::string, std::string>>();
    CLI::App* const creating = command->add_subcommand("new", "write a scene file to begin with; list the templates");
    creating->add_option("template", words->first, "the template; without it, the templates are listed");
    creating->add_option("file", words->second, "the file to write [TEMPLATE.json]; it must not exist");
    creating->callback([words, &exitCode] { exitCode = create(words->first, words->second); });

    command->add_subcommand("schema", "print the JSON Schema of scene files, for editors")->callback([&exitCode] {
        fmt::print("{}\n", scene::jsonSchema());
        exitCode = exitDone;
    });

    const auto messages = std::make_shared<std::vector<std::string>>();
    CLI::App* const describing =
        command->add_subcommand("fields", "print the fields of scenes with unit, default, allowed values and meaning");
    describing->add_option("messages", *messages, "the parts of a scene in one table, such as Group [all, one by one]");
    describing->callback([messages, &exitCode] { exitCode = fields(*messages); });
}

}  // namespace spherule::cli

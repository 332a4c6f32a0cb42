#include "cli/errors.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <climits>
#include <cstdlib>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "cli/exit_codes.h"
#include "core/suggestion.h"
#include "core/text.h"

namespace spherule::cli {

namespace {

struct Usage {
    std::string help = "spherule --help";
    std::map<std::string, std::string> variables{};  // by the option that they set
};

Usage& usage() {
    static Usage own;
    return own;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
    const auto nearest = suggestionFor(word, names);
    return nearest ? fmt::format(" (did you mean {}?)", *nearest) : "";
}

const CLI::App* commandOf(const CLI::App& app) {
    const auto commands = app.get_subcommands();
    return commands.empty() ? nullptr : commands.front();
}

// The command, and within it the chosen part: `scene` and `check`.
std::vector<const CLI::App*> commandsOf(const CLI::App& app) {
    std::vector<const CLI::App*> commands;
    for (const CLI::App* at = commandOf(app); at != nullptr; at = commandOf(*at)) commands.push_back(at);
    return commands;
}

std::string helpOf(const CLI::App& app) {
    std::string words = "spherule";
    for (const CLI::App* command : commandsOf(app)) words += " " + command->get_name();
    return words + " --help";
}

// The variable that set the option; empty if its value came from elsewhere.
std::string variableOf(const CLI::Option& option) {
    const char* const value = option.get_envname().empty() ? nullptr : std::getenv(option.get_envname().c_str());
    if (value == nullptr || *value == 0) return "";
    return fmt::format("{}", fmt::join(option.results(), ",")) == value ? option.get_envname() : "";
}

std::string unknownText(const CLI::App& app, const std::string& word) {
    std::vector<const CLI::App*> chosen = commandsOf(app);
    chosen.insert(chosen.begin(), &app);
    std::vector<std::string> names;
    for (const CLI::App* known : chosen.back()->get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(known->get_name());
    if (!names.empty() && !word.starts_with('-'))
        return fmt::format("\"{}\" is no command{}; there are {}", word, suggestion(word, names),
                           fmt::join(names, ", "));
    if (!word.starts_with('-')) return fmt::format("\"{}\" is one word too many", word);
    names.clear();
    for (const CLI::App* known : chosen)
        for (const CLI::Option* option : known->get_options())
            if (option->nonpositional()) names.push_back(option->get_name());
    return fmt::format("{}: is no option{}", word, suggestion(word, names));
}

std::string wantedText(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    if (option.get_expected_max() == 0) return "true or false";
    if (type.starts_with("UINT")) return "a whole number, not negative";
    if (type.starts_with("INT")) return "a whole number";
    if (type.starts_with("FLOAT")) return "a number";
    return type;
}

// The reason why a value is wrong, without the name of its option.
std::string reasonOf(const CLI::Option& option, const CLI::ParseError& error, const std::string& value) {
    std::string_view reason = error.what();
    for (const std::string own = option.get_name() + ": "; reason.starts_with(own);) reason.remove_prefix(own.size());
    if (reason.find(value) != std::string_view::npos) return std::string(reason);
    return fmt::format("is \"{}\": {}", value, reason);
}

// Describes the first option whose value cannot be read; nullopt if there is none.
std::optional<std::string> valueText(CLI::App& part) {
    for (CLI::Option* option : part.get_options()) {
        if (option->count() == 0) continue;
        const std::string variable = variableOf(*option);
        const std::string& where = variable.empty() ? option->get_name() : variable;
        const std::string value = fmt::format("{}", fmt::join(option->results(), ","));
        try {
            option->run_callback();
        } catch (const CLI::ConversionError&) {
            return fmt::format("{}: is \"{}\", must be {}", where, value, wantedText(*option));
        } catch (const CLI::ParseError& error) {
            return fmt::format("{}: {}", where, reasonOf(*option, error, value));
        }
    }
    return std::nullopt;
}

std::string text(CLI::App& app, const CLI::ParseError& error) {
    if (const auto unknown = app.remaining(true); !unknown.empty()) return unknownText(app, unknown.front());
    const std::string_view what = error.what();
    if (what.starts_with("--config: ") && app.get_option("--config")->count() == 0)
        return fmt::format("SPHERULE_CONFIG: {}", what.substr(10));
    if (error.get_name() != "ConversionError" && error.get_name() != "ValidationError") return std::string(what);
    std::vector<CLI::App*> parts = app.get_subcommands([](CLI::App*) { return true; });
    parts.insert(parts.begin(), &app);
    for (CLI::App* part : parts)
        if (auto wrong = valueText(*part)) return *wrong;
    return std::string(what);
}

}  // namespace

std::string usageText(CLI::App& app, const CLI::ParseError& error) {
    return fmt::format("{}; see `{}`", text(app, error), helpOf(app));
}

void rememberUsage(const CLI::App& app) {
    usage().help = helpOf(app);
    for (const CLI::App* part : {&app, commandOf(app)})
        for (const CLI::Option* option : part == nullptr ? std::vector<const CLI::Option*>() : part->get_options())
            if (const std::string variable = variableOf(*option); !variable.empty())
                usage().variables[option->get_name()] = variable;
}

std::string usageText(const Error& error) {
    if (!error.where.starts_with("--")) return error.text();
    const auto variable = usage().variables.find(error.where);
    const std::string& where = variable == usage().variables.end() ? error.where : variable->second;
    return fmt::format("{}: {}; see `{}`", where, error.message, usage().help);
}

void printLine(const std::string& what) {
    std::string text = fmt::format("spherule: {}\n", withoutControls(what));
    text.resize(cutUtf8(text, PIPE_BUF).size());  // a pipe takes up to PIPE_BUF bytes whole, or none
    pollfd place{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
    if (poll(&place, 1, 1000) <= 0) return;
    const auto written = write(STDERR_FILENO, text.data(), text.size());
    static_cast<void>(written);  // a failure cannot be reported anywhere
}

int printError(const Error& error) {
    const char* const advice = error.kind == ErrorKind::DeviceLost ? "; start it again" : "";
    printLine(usageText(error) + advice);
    return exitCodeOf(error.kind);
}

}  // namespace spherule::cli

#include "cli/config_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <memory>
#include <vector>

#include "core/input_file.h"

namespace spherule::cli {

namespace {

constexpr std::uint64_t longestFile = 1U << 20U;  // bytes

std::string variableFor(const std::string& option) {
    std::string name = "SPHERULE_" + option;
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return c == '-' ? '_' : static_cast<char>(std::toupper(c)); });
    return name;
}

bool isSetting(const CLI::App& command, const CLI::Option& option) {
    return option.get_configurable() && &option != command.get_help_ptr();
}

// CLI11 reads the environment only for options that the file does not set. So this class drops the settings of the file
// that the environment sets.
class FileAfterEnvironment final : public CLI::ConfigTOML {
  public:
    std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
        auto settings = CLI::ConfigTOML::from_config(input);
        std::erase_if(settings, [](const CLI::ConfigItem& item) {
            const char* const value = std::getenv(variableFor(item.name).c_str());
            return value != nullptr && *value != 0;
        });
        return settings;
    }
};

// Quotes a value that is neither a number nor a boolean.
std::string valueText(const std::string& value) {
    double number = 0;
    if (value == "true" || value == "false" || CLI::detail::lexical_cast(value, number)) return value;
    const char quote = value.find('"') == std::string::npos ? '"' : '\'';
    return quote + value + quote;
}

// The value that was given, or else the default; empty if there is neither.
std::string valueOf(const CLI::Option& option) {
    std::vector<std::string> values = option.results();
    if (values.empty() && !option.get_default_str().empty()) values = {option.get_default_str()};
    if (values.empty()) return "";
    if (values.size() == 1) return valueText(values.front());
    std::string list;
    for (const std::string& value : values) list += (list.empty() ? "" : ", ") + valueText(value);
    return "[" + list + "]";
}

}  // namespace

void addSettings(CLI::App& command) {
    command.fallthrough();  // accepts --config, --print-config, --log-format and --verbose too
    for (CLI::Option* option : command.get_options())
        if (isSetting(command, *option)) option->envname(variableFor(option->get_single_name()));
}

void addConfig(CLI::App& app) {
    // CLI11 reads the environment too late for this option, so the variable becomes its default.
    const char* const given = std::getenv("SPHERULE_CONFIG");
    app.set_config("--config", given == nullptr ? "" : given,
                   "a file with settings in the form of --print-config; or SPHERULE_CONFIG")
        ->check([](const std::string& path) {
            const auto text = path.empty() ? "" : readFile(path, longestFile);
            return text ? "" : text.error().text();
        });
    app.config_formatter(std::make_shared<FileAfterEnvironment>());
    app.allow_config_extras(false);
}

std::string settingsText(const CLI::App& app) {
    std::string text;
    for (const CLI::App* command : app.get_subcommands()) {
        text += fmt::format("[{}]\n", command->get_name());
        for (const CLI::Option* option : command->get_options()) {
            if (!isSetting(*command, *option)) continue;
            const std::string value = valueOf(*option);
            text += fmt::format("\n# {}\n", option->get_description());
            if (value.empty())
                text += fmt::format("#{}\n", option->get_single_name());
            else
                text += fmt::format("{}={}\n", option->get_single_name(), value);
        }
    }
    return text;
}

}  // namespace spherule::cli

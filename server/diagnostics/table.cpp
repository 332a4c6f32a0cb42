#include "diagnostics/table.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "core/input_file.h"
#include "embedded/qualityTable.h"
#include "scene/check.h"
#include "scene/quality.h"

namespace spherule::diagnostics {

namespace {

using Json = nlohmann::json;

constexpr std::uint64_t longestFile = 4U << 20U;  // bytes

constexpr std::string_view advice = "; `spherule measure --suite accuracy --out FOLDER` writes FOLDER/measure.json";

// An error at a place in the table.
struct Wrong {
    std::string where;
    std::string what;
};

const Json& member(const Json& object, const std::string& where, const char* name) {
    if (!object.is_object()) throw Wrong{where, "is no object"};
    const auto found = object.find(name);
    if (found == object.end()) throw Wrong{scene::at(where, name), "is missing"};
    return *found;
}

// Nested lists may be too deep to be written: nlohmann/json parses them without recursion, but writes them with it.
std::string shown(const Json& value) {
    if (value.is_structured()) return value.is_array() ? "a list" : "an object";
    return scene::shown(value.dump());
}

double number(const Json& object, const std::string& where, const char* name, double least) {
    const Json& value = member(object, where, name);
    const bool good = value.is_number() && std::isfinite(value.get<double>()) && value.get<double>() >= least;
    if (!good)
        throw Wrong{scene::at(where, name), fmt::format("is {}, must be a number of at least {}", shown(value), least)};
    constexpr double most = 1e12;  // results computed from these numbers stay finite
    if (value.get<double>() > most)
        throw Wrong{scene::at(where, name), fmt::format("is {}, must be at most {}", shown(value), most)};
    return value.get<double>();
}

std::string text(const Json& object, const char* name) {
    const Json& value = member(object, "", name);
    if (!value.is_string()) throw Wrong{name, "is no text"};
    return value.get<std::string>();
}

Measured measuredOf(const Json& json, const std::string& where) {
    constexpr double smallest = 1e-12;
    return {.error = number(json, where, "error", 0),
            .cost = number(json, where, "cost", smallest),
            .substep = number(json, where, "substep", smallest),
            .spheres = static_cast<std::uint32_t>(std::min(number(json, where, "spheres", 1), 1e9))};
}

Rung rungOf(const Json& json, const std::string& where, scene::Model model) {
    Rung rung{.model = model, .factor = number(json, where, "factor", 1e-6), .curves = {}};
    const Json& curves = member(json, where, "curves");
    if (!curves.is_object() || curves.empty()) throw Wrong{scene::at(where, "curves"), "has no curve"};
    for (const auto& [name, curve] : curves.items())
        rung.curves.emplace(name, measuredOf(curve, scene::at(scene::at(where, "curves"), name)));
    return rung;
}

Table tableOf(const Json& json) {
    Table table{.device = text(json, "device"), .renderer = text(json, "renderer"), .rungs = {}};
    const Json& models = member(json, "", "models");
    if (!models.is_object() || models.empty()) throw Wrong{"models", "has no model"};
    for (const auto& [name, rungs] : models.items()) {
        const std::string where = scene::at("models", name);
        const auto model = scene::modelNamed(name);
        if (!model) throw Wrong{where, "is no model; there are fast, balanced and accurate"};
        if (!rungs.is_array()) throw Wrong{where, "is no list"};
        for (std::size_t k = 0; k < rungs.size(); ++k)
            table.rungs.push_back(rungOf(rungs[k], scene::at(where, k), *model));
    }
    std::ranges::sort(table.rungs, {}, [](const Rung& rung) { return std::pair(rung.model, rung.factor); });
    return table;
}

std::string lineAndColumn(std::string_view text, std::size_t offset) {
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    const std::size_t newline = before.rfind('\n');
    return fmt::format("{}:{}", 1 + std::ranges::count(before, '\n'),
                       newline == std::string_view::npos ? before.size() + 1 : before.size() - newline);
}

}  // namespace

Result<Table> parseTable(const std::string& text, std::string_view file) {
    try {
        return tableOf(Json::parse(text));
    } catch (const Json::parse_error& error) {
        const std::size_t offset = error.byte > 0 ? error.byte - 1 : 0;
        return fail(ErrorKind::Input, fmt::format("{}:{}", file, lineAndColumn(text, offset)),
                    fmt::format("is not JSON{}", advice));
    } catch (const Json::exception&) {
        return fail(ErrorKind::Input, std::string(file), fmt::format("holds a number that is too large{}", advice));
    } catch (const Wrong& wrong) {
        const std::string where = wrong.where.empty() ? std::string(file) : fmt::format("{}: {}", file, wrong.where);
        return fail(ErrorKind::Input, where, fmt::format("{}{}", wrong.what, advice));
    }
}

Result<Table> loadTable(const std::string& path) {
    const auto text = readFile(path, longestFile);
    if (!text) return fail(ErrorKind::Input, path, fmt::format("{}{}", text.error().message, advice));
    return parseTable(*text, path);
}

Table ownTable() {
    const embedded::File& file = embedded::qualityTable().front();
    auto table = parseTable(std::string(file.bytes), file.path);
    if (!table) throw std::logic_error(table.error().text());
    return std::move(*table);
}

}  // namespace spherule::diagnostics

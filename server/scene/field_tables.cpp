#include "scene/field_tables.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <spdlog/fmt/fmt.h>
#include <nlohmann/json.hpp>

#include "core/suggestion.h"
#include "scene/check.h"
#include "scene/field_rules.h"

namespace spherule::scene {

namespace {

namespace pb = google::protobuf;
using pb::FieldDescriptor;

std::string raised(int exponent) {
    constexpr std::array digits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = exponent < 0 ? "⁻" : "";
    for (const char digit : fmt::format("{}", std::abs(exponent)))
        text += digits.at(static_cast<std::size_t>(digit - '0'));
    return text;
}

// Returns the number as a table has it: 1,000, 10⁹, −0.99.
std::string number(double value) {
    constexpr double longest = 1e6;
    if (value < 0) return "−" + number(-value);
    const double exponent = value > 0 ? std::round(std::log10(value)) : 0;
    const bool power = value > 0 && std::abs(value / std::pow(10, exponent) - 1) < 1e-9;
    if (power && (exponent < -2 || value > longest)) return "10" + raised(static_cast<int>(exponent));
    std::string text = fmt::format("{}", value);
    if (value >= 1000 && text.find_first_not_of("0123456789") == std::string::npos)
        for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3)
            text.insert(static_cast<std::size_t>(at), ",");
    return text;
}

std::string code(std::string_view text) {
    return fmt::format("`{}`", text);
}

std::string rangeText(const FieldDescriptor& field) {
    const v1::Rule& rule = ruleOf(field);
    const std::string above = rule.has_above() ? "above " + number(rule.above()) : "";
    if (rule.has_max() && rule.has_min()) return fmt::format("{} to {}", number(rule.min()), number(rule.max()));
    if (rule.has_max()) return fmt::format("{}{}up to {}", above, above.empty() ? "" : ", ", number(rule.max()));
    if (rule.has_above()) return above;
    if (rule.has_min()) return "at least " + number(rule.min());
    return "";
}

std::string allowedText(const FieldDescriptor& field) {
    const v1::Rule& rule = ruleOf(field);
    if (rule.vector()) return "vector";
    if (!rule.pattern().empty()) return "a colour";
    std::string text = rangeText(field);
    if (const pb::EnumDescriptor* const values = field.enum_type()) {
        for (const std::string& name : namesOf(*values)) text += (text.empty() ? "" : ", ") + code(name);
        if (field.is_repeated()) text = "list of " + text;
    }
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_BOOL) text = "`true`, `false`";
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_UINT64 && text.empty()) text = "0 to 2⁶⁴ − 1";
    if (rule.most() > 0) text = fmt::format("up to {}{}", number(rule.most()), field.is_repeated() ? "" : " bytes");
    return text;
}

std::string defaultText(const FieldDescriptor& field) {
    const v1::Rule& rule = ruleOf(field);
    if (rule.required()) return "required";
    const pb::OneofDescriptor* const oneof = field.real_containing_oneof();
    if (oneof != nullptr && rule.absent().empty()) return needsOne(*oneof) ? "one is required" : "none";
    const auto value = nlohmann::json::parse(rule.absent(), nullptr, false);
    return value.is_boolean() || value.is_array() ? code(rule.absent()) : rule.absent();
}

const pb::Descriptor* messageNamed(std::string_view name) {
    const auto messages = messagesOfScene();
    const auto found = std::ranges::find(messages, name, [](const auto* message) { return message->name(); });
    return found == messages.end() ? nullptr : *found;
}

void addRows(std::string& table, const pb::Descriptor& message, std::string_view prefix) {
    for (int k = 0; k < message.field_count(); ++k) {
        const FieldDescriptor& field = *message.field(k);
        for (const std::string& cell : {code(at(prefix, field.json_name())), ruleOf(field).unit(), defaultText(field),
                                        allowedText(field), meaningOf(field)})
            table += cell.empty() ? "| " : fmt::format("| {} ", cell);
        table += "|\n";
    }
}

constexpr std::string_view head = "| field | unit | default | allowed | meaning |\n|---|---|---|---|---|\n";

}  // namespace

Result<std::string> fieldTable(const std::vector<std::string>& messages) {
    std::string table(head);
    for (const std::string& name : messages) {
        const std::size_t end = name.find('=');
        const std::string prefix = end == std::string::npos ? "" : name.substr(0, end);
        const std::string wanted = end == std::string::npos ? name : name.substr(end + 1);
        const pb::Descriptor* const message = messageNamed(wanted);
        if (message == nullptr) {
            std::vector<std::string> known;
            for (const pb::Descriptor* one : messagesOfScene()) known.push_back(one->name());
            const auto nearest = suggestionFor(wanted, known);
            return fail(
                ErrorKind::Input, shown(wanted),
                fmt::format("is no message of a scene{}; there are {}",
                            nearest ? fmt::format(" (did you mean {}?)", *nearest) : "", fmt::join(known, ", ")));
        }
        addRows(table, *message, prefix);
    }
    return table;
}

std::string fieldTables() {
    std::string text;
    for (const pb::Descriptor* message : messagesOfScene()) {
        text +=
            fmt::format("{}## {}\n\n{}\n\n{}", text.empty() ? "" : "\n", message->name(), meaningOf(*message), head);
        addRows(text, *message, "");
    }
    return text;
}

}  // namespace spherule::scene

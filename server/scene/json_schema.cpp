#include "scene/json_schema.h"

#include <spdlog/fmt/fmt.h>
#include <nlohmann/json.hpp>

#include "scene/check.h"
#include "scene/field_rules.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

namespace pb = google::protobuf;
using Json = nlohmann::ordered_json;
using pb::FieldDescriptor;

std::string definition(const pb::Descriptor& message) {
    return "#/$defs/" + message.name();
}

// Limits a number that is a whole one as JSON's integers.
Json limited(Json schema, const FieldDescriptor& field) {
    const v1::Rule& rule = ruleOf(field);
    const auto limit = [&](double value) {
        return isWhole(field) ? Json(static_cast<std::uint64_t>(value)) : Json(value);
    };
    if (rule.has_min()) schema["minimum"] = limit(rule.min());
    if (rule.has_above()) schema["exclusiveMinimum"] = limit(rule.above());
    if (rule.has_max()) schema["maximum"] = limit(rule.max());
    if (isWhole(field) && !rule.has_min()) schema["minimum"] = 0;
    if (rule.vector()) schema.update({{"minimum", -largestComponent}, {"maximum", largestComponent}});
    return schema;
}

// A value, or an entry of a list.
Json valueSchema(const FieldDescriptor& field) {
    const v1::Rule& rule = ruleOf(field);
    switch (field.cpp_type()) {
        case FieldDescriptor::CPPTYPE_MESSAGE:
            return {{"$ref", definition(*field.message_type())}};
        case FieldDescriptor::CPPTYPE_ENUM:
            return {{"enum", namesOf(*field.enum_type())}};
        case FieldDescriptor::CPPTYPE_BOOL:
            return {{"type", "boolean"}};
        case FieldDescriptor::CPPTYPE_STRING: {
            Json schema{{"type", "string"}};
            if (field.type() == FieldDescriptor::TYPE_BYTES) schema["contentEncoding"] = "base64";
            if (!rule.pattern().empty()) schema["pattern"] = fmt::format("^{}$", rule.pattern());
            // JSON Schema counts characters, and Base64 has four of them for three bytes.
            if (rule.most() > 0)
                schema["maxLength"] = schema.contains("contentEncoding") ? (rule.most() + 2) / 3 * 4 : rule.most();
            return schema;
        }
        case FieldDescriptor::CPPTYPE_UINT64:
            return {{"anyOf", {limited({{"type", "integer"}}, field), {{"type", "string"}, {"pattern", "^[0-9]+$"}}}}};
        case FieldDescriptor::CPPTYPE_UINT32:
            return limited({{"type", "integer"}}, field);
        default:
            return limited({{"type", "number"}}, field);
    }
}

// The value of an absent field as JSON; discarded if its rule has words.
Json absentValue(const FieldDescriptor& field) {
    std::string text = ruleOf(field).absent();
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM && text.size() > 2)
        return text.substr(1, text.size() - 2);  // a name in back quotes
    return Json::parse(text, nullptr, false);
}

std::string descriptionOf(const FieldDescriptor& field, bool withAbsent) {
    const v1::Rule& rule = ruleOf(field);
    std::string text = meaningOf(field);
    const auto add = [&](const char* name, const std::string& value) {
        if (!value.empty()) text += fmt::format("{}{}: {}.", text.empty() ? "" : "\n\n", name, value);
    };
    add("Unit", rule.unit());
    if (withAbsent) add("Default", rule.absent());
    return text;
}

Json fieldSchema(const FieldDescriptor& field) {
    const v1::Rule& rule = ruleOf(field);
    Json schema = valueSchema(field);
    if (field.is_repeated()) schema = {{"type", "array"}, {"items", std::move(schema)}};
    if (rule.vector()) schema.update({{"minItems", 3}, {"maxItems", 3}});
    if (field.is_repeated() && rule.most() > 0) schema["maxItems"] = rule.most();
    const Json absent = absentValue(field);
    if (!absent.is_discarded()) schema["default"] = absent;
    schema["description"] = descriptionOf(field, absent.is_discarded());
    return schema;
}

Json oneofSchema(const pb::OneofDescriptor& oneof) {
    Json members = Json::array();
    for (const std::string& name : namesOf(oneof)) members.push_back({{"required", {name}}});
    Json choices = members;
    if (!needsOne(oneof)) choices.push_back({{"not", {{"anyOf", members}}}});
    return {{"oneOf", choices}};
}

Json messageSchema(const pb::Descriptor& message) {
    Json schema{{"type", "object"}, {"description", meaningOf(message)}, {"properties", Json::object()}};
    Json required = Json::array();
    for (int k = 0; k < message.field_count(); ++k) {
        const FieldDescriptor& field = *message.field(k);
        schema["properties"][field.json_name()] = fieldSchema(field);
        if (ruleOf(field).required()) required.push_back(field.json_name());
    }
    if (!required.empty()) schema["required"] = required;
    schema["additionalProperties"] = false;
    for (int k = 0; k < message.real_oneof_decl_count(); ++k)
        schema["allOf"].push_back(oneofSchema(*message.oneof_decl(k)));
    return schema;
}

}  // namespace

std::string jsonSchema() {
    Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                {"title", "Spherule scene"},
                {"$ref", definition(*v1::Scene::descriptor())}};
    for (const pb::Descriptor* message : messagesOfScene()) schema["$defs"][message->name()] = messageSchema(*message);
    return schema.dump(2);
}

}  // namespace spherule::scene

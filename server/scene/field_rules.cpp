#include "scene/field_rules.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>

#include <google/protobuf/descriptor.pb.h>
#include <spdlog/fmt/fmt.h>

#include "embedded/sceneComments.h"
#include "scene/check.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::scene {

namespace {

namespace pb = google::protobuf;

// A comment on one line.
std::string joined(const std::string& comment) {
    std::string line;
    for (const char c : comment) {
        const bool space = std::isspace(static_cast<unsigned char>(c)) != 0;
        if (!space) line += c;
        if (space && !line.empty() && line.back() != ' ') line += ' ';
    }
    if (line.ends_with(' ')) line.pop_back();
    return line;
}

// Adds the comments of a file by the full names of messages and fields.
void addComments(const pb::FileDescriptorProto& file, std::map<std::string, std::string>& all) {
    const std::string package = file.package() + ".";
    for (const auto& one : file.source_code_info().location()) {
        if (!one.has_leading_comments() || one.path_size() < 2 ||
            one.path(0) != pb::FileDescriptorProto::kMessageTypeFieldNumber)
            continue;
        const pb::DescriptorProto& message = file.message_type(one.path(1));
        if (one.path_size() == 2) all[package + message.name()] = joined(one.leading_comments());
        if (one.path_size() == 4 && one.path(2) == pb::DescriptorProto::kFieldFieldNumber)
            all[package + message.name() + "." + message.field(one.path(3)).name()] = joined(one.leading_comments());
    }
}

std::string commentOf(const std::string& fullName) {
    static const auto comments = [] {
        std::map<std::string, std::string> all;
        pb::FileDescriptorSet set;
        for (const embedded::File& file : embedded::sceneComments())
            set.ParseFromArray(file.bytes.data(), static_cast<int>(file.bytes.size()));
        for (const pb::FileDescriptorProto& file : set.file()) addComments(file, all);
        return all;
    }();
    const auto found = comments.find(fullName);
    return found == comments.end() ? "" : found->second;
}

void addMessages(const pb::Descriptor& message, std::vector<const pb::Descriptor*>& all) {
    if (std::ranges::find(all, &message) != all.end()) return;
    all.push_back(&message);
    for (int k = 0; k < message.field_count(); ++k)
        if (const pb::Descriptor* const part = message.field(k)->message_type()) addMessages(*part, all);
}

}  // namespace

const v1::Rule& ruleOf(const pb::FieldDescriptor& field) {
    return field.options().GetExtension(v1::rule);
}

bool needsOne(const pb::OneofDescriptor& oneof) {
    return oneof.options().GetExtension(v1::one_required);
}

std::string meaningOf(const pb::Descriptor& message) {
    return commentOf(message.full_name());
}

std::string meaningOf(const pb::FieldDescriptor& field) {
    std::string own = commentOf(field.full_name());
    return own.empty() && field.message_type() != nullptr ? meaningOf(*field.message_type()) : own;
}

std::vector<std::string> namesOf(const pb::EnumDescriptor& values) {
    std::vector<std::string> names;
    for (int k = 0; k < values.value_count(); ++k)
        if (values.value(k)->number() != 0) names.push_back(values.value(k)->name());
    return names;
}

std::vector<std::string> namesOf(const pb::OneofDescriptor& oneof) {
    std::vector<std::string> names;
    for (int k = 0; k < oneof.field_count(); ++k) names.push_back(oneof.field(k)->json_name());
    return names;
}

std::vector<std::string> namesOf(const pb::Descriptor& message) {
    std::vector<std::string> names;
    for (int k = 0; k < message.field_count(); ++k) names.push_back(message.field(k)->json_name());
    return names;
}

std::vector<const pb::Descriptor*> messagesOfScene() {
    std::vector<const pb::Descriptor*> all;
    addMessages(*v1::Scene::descriptor(), all);
    return all;
}

bool isWhole(const pb::FieldDescriptor& field) {
    return field.cpp_type() == pb::FieldDescriptor::CPPTYPE_UINT32 ||
           field.cpp_type() == pb::FieldDescriptor::CPPTYPE_UINT64;
}

std::string wantedText(const pb::FieldDescriptor& field) {
    switch (field.cpp_type()) {
        case pb::FieldDescriptor::CPPTYPE_MESSAGE:
            return "an object";
        case pb::FieldDescriptor::CPPTYPE_ENUM:
            return "one of " + fmt::format("{}", fmt::join(namesOf(*field.enum_type()), ", "));
        case pb::FieldDescriptor::CPPTYPE_BOOL:
            return "true or false";
        case pb::FieldDescriptor::CPPTYPE_STRING:
            return "a text";
        case pb::FieldDescriptor::CPPTYPE_UINT32:
        case pb::FieldDescriptor::CPPTYPE_UINT64:
            return "a whole number, not negative";
        default:
            return "a number";
    }
}

std::string whyOutOfRange(const pb::FieldDescriptor& field, double value) {
    const v1::Rule& rule = ruleOf(field);
    const double lowest =
        rule.vector() ? -largestComponent : (isWhole(field) ? 0 : -std::numeric_limits<double>::max());
    const double whole = field.cpp_type() == pb::FieldDescriptor::CPPTYPE_UINT64 ? largestWhole : 0x1p32 - 1;
    const double highest = rule.vector() ? largestComponent : (isWhole(field) ? whole : -lowest);
    const double low = rule.has_min() ? rule.min() : lowest;
    const double high = rule.has_max() ? rule.max() : highest;
    const std::string unit = rule.unit().empty() ? "" : " " + rule.unit();
    if (rule.has_above() && value <= rule.above())
        return fmt::format("is {}, must be above {}{}", value, rule.above(), unit);
    if (value >= low && value <= high) return "";
    const bool bounded = rule.has_max() || rule.vector();
    if (bounded && !rule.has_above()) return fmt::format("is {}, must be {} to {}{}", value, low, high, unit);
    return value > high ? fmt::format("is {}, must be at most {}{}", value, high, unit)
                        : fmt::format("is {}, must be at least {}{}", value, low, unit);
}

std::string otherOwnersOf(std::string_view field, const google::protobuf::Descriptor& message) {
    constexpr std::size_t most = 2;
    std::vector<std::string> owners;
    for (const google::protobuf::Descriptor* const one : messagesOfScene())
        for (int k = 0; k < one->field_count() && one != &message; ++k)
            if (one->field(k)->json_name() == field) owners.push_back(one->name());
    if (owners.empty() || owners.size() > most) return "";
    return fmt::format("; {} {} one of this name", fmt::join(owners, " and "), owners.size() == 1 ? "has" : "have");
}

}  // namespace spherule::scene

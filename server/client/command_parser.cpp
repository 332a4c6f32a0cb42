#include "client/command_parser.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <span>
#include <utility>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/json_util.h>

#include "core/json_error.h"
#include "core/quantity.h"
#include "net/command_rules.h"

namespace spherule::client {

namespace {

// The commands with forms of their own. commandForms() adds the others.
constexpr std::string_view ownForms =
    "  query [hash]                               prints the statistics as JSON; hash: with the hash of the state\n"
    "  step [N]\n"
    "  load NAME | load FILE.json\n"
    "  set gravity X Y Z | set restitution E | set friction F | set speed S\n"
    "  set model fast|balanced|accurate | set substeps N\n"
    "  set auto MSms | set auto PERCENT% | set auto off   adapt substeps to a time per step or a mean overlap\n"
    "  spawn JSON                                 adds a group of spheres\n"
    "  remove SPHERE ... | remove region XMIN YMIN ZMIN XMAX YMAX ZMAX\n"
    "  add_obstacle JSON                          adds an obstacle; its motion begins now\n"
    "  move_obstacle N [X Y Z | JSON]             moves it at once by X Y Z (m), or as the JSON says; ends its motion\n"
    "  add_field JSON | change_field N JSON       a force on every sphere, such as a wind\n"
    "  add_emitter JSON | change_emitter N JSON   makes spheres\n"
    "  add_material JSON | change_material N JSON\n"
    "  set_pair JSON                              values between two materials; without values: removes them\n"
    "  change_group N JSON                        its name, material, colour, roughness or metal\n"
    "  push SPHERE JX JY JZ                       applies an impulse (N s)\n"
    "  push ray OX OY OZ DX DY DZ JX JY JZ        to the first sphere that the ray hits\n"
    "  record | record stop\n";

namespace pb = google::protobuf;

using Words = std::span<const std::string>;

constexpr std::uintmax_t largestScene = std::uintmax_t{16}
                                        << 20U;  // bytes of JSON; a server accepts messages up to 1 MiB

tl::unexpected<Error> refuse(const std::string& what) {
    return fail(ErrorKind::Input, "command", what + "; accepted are\n" + commandForms());
}

// Parses a finite number that fills the whole word.
template <class T>
Result<T> number(const std::string& word) {
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    bool good = error == std::errc() && end == word.data() + word.size();
    if constexpr (std::is_floating_point_v<T>) good = good && std::isfinite(value);
    if (!good) return refuse("'" + word + "' is no " + (std::is_integral_v<T> ? "whole number" : "number"));
    return value;
}

template <class Field>
Result<void> numbers(Words words, Field* field) {
    for (const std::string& word : words) {
        const auto value = number<double>(word);
        if (!value) return tl::unexpected(value.error());
        field->Add(*value);
    }
    return {};
}

std::string upper(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

// Sets a field to the value of the word, or adds the value to a list. Every field of a command with help, and every
// field of Set except `auto`, has one of these types.
Result<void> readField(const std::string& word, pb::Message& message, const pb::FieldDescriptor& field) {
    const pb::Reflection& fields = *message.GetReflection();
    if (field.cpp_type() == pb::FieldDescriptor::CPPTYPE_DOUBLE) {
        const auto value = number<double>(word);
        if (!value) return tl::unexpected(value.error());
        field.is_repeated() ? fields.AddDouble(&message, &field, *value) : fields.SetDouble(&message, &field, *value);
    } else if (field.cpp_type() == pb::FieldDescriptor::CPPTYPE_UINT32) {
        const auto value = number<std::uint32_t>(word);
        if (!value) return tl::unexpected(value.error());
        fields.SetUInt32(&message, &field, *value);
    } else if (field.cpp_type() == pb::FieldDescriptor::CPPTYPE_UINT64) {
        const auto value = number<std::uint64_t>(word);
        if (!value) return tl::unexpected(value.error());
        fields.SetUInt64(&message, &field, *value);
    } else if (field.cpp_type() == pb::FieldDescriptor::CPPTYPE_ENUM) {
        const auto* const value = field.enum_type()->FindValueByName(upper(word));
        if (value == nullptr || value->number() == 0) return refuse("'" + word + "' is no " + field.name());
        fields.SetEnum(&message, &field, value);
    } else {
        return refuse("'" + field.name() + "' can be given in JSON only");
    }
    return {};
}

Result<void> readJson(const std::string& json, const std::string& where, const char* what, pb::Message& message) {
    const auto status = google::protobuf::util::JsonStringToMessage(json, &message);
    if (status.ok()) return {};
    const JsonError error = jsonErrorOf({status.message().data(), status.message().size()}, json, what);
    const char* const separator = error.isJson && !error.place.empty() ? ": " : "";
    return fail(ErrorKind::Input, where + separator + error.place, error.reason);
}

template <class Message>
Result<Message> fromJson(const std::string& json, const std::string& where, const char* what) {
    Message message;
    if (auto read = readJson(json, where, what, message); !read) return tl::unexpected(read.error());
    return message;
}

Result<void> wantWords(Words words, std::size_t count, const std::string& command) {
    if (words.size() == count) return {};
    return refuse("'" + command + "' takes " + std::to_string(count) + " words, not " + std::to_string(words.size()));
}

Result<void> query(Words words, v1::Command& command) {
    command.mutable_query()->set_hash(!words.empty());
    if (words.empty() || (words.size() == 1 && words[0] == "hash")) return {};
    return refuse("'query' takes nothing, or 'hash'");
}

Result<void> step(Words words, v1::Command& command) {
    command.mutable_step()->set_count(1);
    if (words.empty()) return {};
    if (auto right = wantWords(words, 1, "step"); !right) return right;
    const auto count = number<std::uint32_t>(words[0]);
    if (!count) return tl::unexpected(count.error());
    command.mutable_step()->set_count(*count);
    return {};
}

Result<void> load(Words words, v1::Command& command) {
    if (auto right = wantWords(words, 1, "load"); !right) return right;
    const std::string& source = words[0];
    if (!source.ends_with(".json")) {
        command.mutable_load()->set_name(source);
        return {};
    }
    std::error_code error;
    if (!std::filesystem::is_regular_file(source, error))
        return fail(ErrorKind::Input, source,
                    std::string(std::filesystem::exists(source, error) ? "is not a file" : "there is no such file") +
                        "; give the path of a scene file on this machine, which is sent, or the name of a scene of "
                        "the server, without .json");
    if (std::filesystem::file_size(source, error) > largestScene)
        return fail(ErrorKind::Input, source,
                    "is larger than 16 MiB, and a server takes messages of 1 MiB: start it with this file");
    std::ifstream file(source, std::ios::binary);
    if (!file) return fail(ErrorKind::Input, source, "cannot be read: see its permissions");
    auto scene = fromJson<v1::Scene>({std::istreambuf_iterator<char>(file), {}}, source, "a scene");
    if (!scene) return tl::unexpected(scene.error());
    *command.mutable_load()->mutable_scene() = std::move(*scene);
    return {};
}

// "16ms", "0.5%" or "off".
Result<void> setAuto(const std::string& words, v1::Auto& goal) {
    if (words == "off") return {};
    const auto given = quantityOf(words);
    if (given && given->unit == "ms")
        goal.set_budget_ms(given->number);
    else if (given && given->unit == "%")
        goal.set_overlap(given->number / 100);
    else
        return refuse("'" + words + "' is no goal for auto");
    return {};
}

Result<void> set(Words words, v1::Command& command) {
    if (words.empty()) return refuse("'set' needs a name and a value");
    const std::string& name = words[0];
    const Words values = words.subspan(1);
    v1::Set& change = *command.mutable_set();
    const auto* const field = v1::Set::descriptor()->FindFieldByName(name);
    if (field == nullptr) return refuse("'" + name + "' cannot be set");
    if (auto right = wantWords(values, field->is_repeated() ? 3 : 1, "set " + name); !right) return right;
    if (field->number() == v1::Set::kAutoFieldNumber) return setAuto(values[0], *change.mutable_auto_());
    for (const std::string& value : values)
        if (auto read = readField(value, change, *field); !read) return read;
    return {};
}

// The number of a part if the command names one, then the part as JSON. A command without a message for the part has
// its other fields in the JSON.
Result<void> part(const pb::FieldDescriptor& kind, Words words, v1::Command& command) {
    pb::Message& message = *command.GetReflection()->MutableMessage(&command, &kind);
    const pb::Descriptor& type = *kind.message_type();
    const auto* const number = type.FindFieldByName("number");
    if (auto right = wantWords(words, number == nullptr ? 1 : 2, kind.name()); !right) return right;
    const auto* const content = type.field(number == nullptr ? 0 : 1);
    const bool whole = content->message_type() == nullptr;
    pb::Message& to = whole ? message : *message.GetReflection()->MutableMessage(&message, content);
    const std::string what =
        whole ? "a change"
              : (content->name() == "obstacle" || content->name() == "emitter" ? "an " : "a ") + content->name();
    if (auto read = readJson(words.back(), kind.name(), what.c_str(), to); !read) return read;
    return number == nullptr ? Result<void>() : readField(words[0], message, *number);
}

// The number of the obstacle, then either x y z, or the move as JSON. Without either, the obstacle stops.
Result<void> moveObstacle(Words words, v1::Command& command) {
    if (words.empty()) return refuse("'move_obstacle' needs the number of an obstacle");
    const auto obstacle = number<std::uint32_t>(words[0]);
    if (!obstacle) return tl::unexpected(obstacle.error());
    v1::MoveObstacle& move = *command.mutable_move_obstacle();
    if (words.size() == 2) {
        auto read = fromJson<v1::MoveObstacle>(words[1], "move_obstacle", "a move");
        if (!read) return tl::unexpected(read.error());
        move = std::move(*read);
    } else if (words.size() > 1) {
        if (auto right = wantWords(words, 4, "move_obstacle"); !right) return right;
        if (auto read = numbers(words.subspan(1), move.mutable_by()); !read) return read;
    }
    move.set_obstacle(*obstacle);
    return {};
}

Result<void> remove(Words words, v1::Command& command) {
    v1::Remove& remove = *command.mutable_remove();
    if (!words.empty() && words[0] == "region") {
        if (auto right = wantWords(words, 7, "remove"); !right) return right;
        auto read = numbers(words.subspan(1, 3), remove.mutable_region()->mutable_min());
        if (read) read = numbers(words.subspan(4, 3), remove.mutable_region()->mutable_max());
        return read;
    }
    if (words.empty()) return refuse("'remove' needs ids of spheres, or a region");
    for (const std::string& word : words) {
        const auto sphere = number<std::uint64_t>(word);
        if (!sphere) return tl::unexpected(sphere.error());
        remove.add_spheres(*sphere);
    }
    return {};
}

Result<void> push(Words words, v1::Command& command) {
    v1::Push& push = *command.mutable_push();
    if (!words.empty() && words[0] == "ray") {
        if (auto right = wantWords(words, 10, "push"); !right) return right;
        auto read = numbers(words.subspan(1, 3), push.mutable_ray()->mutable_origin());
        if (read) read = numbers(words.subspan(4, 3), push.mutable_ray()->mutable_direction());
        if (read) read = numbers(words.subspan(7, 3), push.mutable_impulse());
        return read;
    }
    if (auto right = wantWords(words, 4, "push"); !right) return right;
    const auto sphere = number<std::uint64_t>(words[0]);
    if (!sphere) return tl::unexpected(sphere.error());
    push.set_sphere(*sphere);
    return numbers(words.subspan(1), push.mutable_impulse());
}

Result<void> record(Words words, v1::Command& command) {
    if (words.empty()) {
        command.mutable_start_recording();
        return {};
    }
    if (words.size() > 1 || words[0] != "stop") return refuse("'record' takes nothing, or 'stop'");
    command.mutable_stop_recording();
    return {};
}

// A command whose words are the values of its fields, in their order.
Result<void> plain(const pb::FieldDescriptor& kind, Words words, v1::Command& command) {
    const pb::Descriptor& type = *kind.message_type();
    const auto count = static_cast<std::size_t>(type.field_count());
    if (words.size() > count) return refuse("'" + words[count] + "' is one word too many");
    if (auto right = wantWords(words, count, kind.name()); !right) return right;
    pb::Message& message = *command.GetReflection()->MutableMessage(&command, &kind);
    for (int k = 0; k < type.field_count(); ++k)
        if (auto read = readField(words[static_cast<std::size_t>(k)], message, *type.field(k)); !read) return read;
    return {};
}

// "seek TIME".
std::string plainForm(const pb::FieldDescriptor& kind) {
    std::string form = kind.name();
    for (int k = 0; k < kind.message_type()->field_count(); ++k)
        form.append(" ").append(upper(kind.message_type()->field(k)->name()));
    return form;
}

using Parse = Result<void> (*)(Words, v1::Command&);

// The parsers of the commands with forms of their own.
const std::map<std::string_view, Parse>& parsers() {
    static const std::map<std::string_view, Parse> table = {
        {"query", query},   {"step", step}, {"load", load},     {"set", set},
        {"remove", remove}, {"push", push}, {"record", record}, {"move_obstacle", moveObstacle}};
    return table;
}

// The commands that part() reads.
bool isPart(std::string_view name) {
    constexpr std::array<std::string_view, 10> names = {
        "spawn",          "add_obstacle", "add_field",       "change_field", "add_emitter",
        "change_emitter", "add_material", "change_material", "set_pair",     "change_group"};
    return std::ranges::find(names, name) != names.end();
}

Result<void> parse(const std::string& name, Words words, v1::Command& command) {
    if (const auto own = parsers().find(name); own != parsers().end()) return own->second(words, command);
    for (const auto* const kind : net::commandFields()) {
        if (kind->name() != name) continue;
        if (isPart(name)) return part(*kind, words, command);
        if (!kind->options().GetExtension(v1::command_rules).help().empty()) return plain(*kind, words, command);
    }
    return refuse("'" + name + "' is no command");
}

}  // namespace

std::string commandForms() {
    constexpr std::size_t helpColumn = 43;
    std::string forms;
    for (const auto* const kind : net::commandFields()) {
        const std::string& help = kind->options().GetExtension(v1::command_rules).help();
        if (help.empty()) continue;
        std::string line = plainForm(*kind);
        line.resize(std::max(helpColumn, line.size() + 1), ' ');
        forms.append("  ").append(line).append(help).append("\n");
    }
    forms += ownForms;
    forms.append("  JSON                                       a command, such as {\"step\":{\"count\":10}}");
    return forms;
}

Result<v1::Command> commandFrom(const std::vector<std::string>& words) {
    if (words.empty()) return refuse("nothing was given");
    if (words.size() == 1 && words[0].starts_with('{')) {
        auto command = fromJson<v1::Command>(words[0], "command", "a command");
        if (command && command->kind_case() == v1::Command::KIND_NOT_SET) return refuse("the JSON names no command");
        return command;
    }
    v1::Command command;
    if (auto parsed = parse(words[0], Words(words).subspan(1), command); !parsed) return tl::unexpected(parsed.error());
    return command;
}

}  // namespace spherule::client

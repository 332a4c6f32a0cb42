#include "client/command_parser.h"

#include <algorithm>
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

#include <google/protobuf/util/json_util.h>

#include "core/json_error.h"
#include "core/quantity.h"

namespace spherule::client {

const std::string_view commandForms =
    "  pause\n"
    "  resume\n"
    "  step [N]\n"
    "  reset\n"
    "  cancel                                     ends a load, a spawn or steps in progress\n"
    "  load NAME | load FILE.json\n"
    "  set gravity X Y Z | set restitution E | set friction F | set speed S\n"
    "  set model fast|balanced|accurate | set substeps N\n"
    "  set auto MSms | set auto PERCENT% | set auto off   adapt substeps to a time per step or a mean overlap\n"
    "  spawn JSON                                 adds a group of spheres\n"
    "  push SPHERE JX JY JZ                       applies an impulse (N s)\n"
    "  push ray OX OY OZ DX DY DZ JX JY JZ        to the first sphere that the ray hits\n"
    "  seek SECONDS                               moves a recording to this time\n"
    "  record | record stop\n"
    "  query\n"
    "  JSON                                       a command, such as {\"step\":{\"count\":10}}";

namespace {

using Words = std::span<const std::string>;

constexpr std::uintmax_t largestScene = std::uintmax_t{16}
                                        << 20U;  // bytes of JSON; a server accepts messages up to 1 MiB

tl::unexpected<Error> refuse(const std::string& what) {
    return fail(ErrorKind::Input, "command", what + "; accepted are\n" + std::string(commandForms));
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

template <class Message>
Result<Message> fromJson(const std::string& json, const std::string& where, const char* what) {
    Message message;
    const auto status = google::protobuf::util::JsonStringToMessage(json, &message);
    if (status.ok()) return message;
    const JsonError error = jsonErrorOf({status.message().data(), status.message().size()}, json, what);
    const char* const separator = error.isJson && !error.place.empty() ? ": " : "";
    return fail(ErrorKind::Input, where + separator + error.place, error.reason);
}

Result<void> wantWords(Words words, std::size_t count, const std::string& command) {
    if (words.size() == count) return {};
    return refuse("'" + command + "' takes " + std::to_string(count) + " words, not " + std::to_string(words.size()));
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
    if (name == "gravity") {
        if (auto right = wantWords(values, 3, "set gravity"); !right) return right;
        return numbers(values, change.mutable_gravity());
    }
    static const std::map<std::string_view, void (v1::Set::*)(double)> numbersByName = {
        {"restitution", &v1::Set::set_restitution},
        {"friction", &v1::Set::set_friction},
        {"speed", &v1::Set::set_speed}};
    const auto plainNumber = numbersByName.find(name);
    if (plainNumber == numbersByName.end() && name != "substeps" && name != "model" && name != "auto")
        return refuse("'" + name + "' cannot be set");
    if (auto right = wantWords(values, 1, "set " + name); !right) return right;
    if (name == "substeps") {
        const auto count = number<std::uint32_t>(values[0]);
        if (!count) return tl::unexpected(count.error());
        change.set_substeps(*count);
        return {};
    }
    if (name == "auto") return setAuto(values[0], *change.mutable_auto_());
    if (name == "model") {
        std::string upper = values[0];
        std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return std::toupper(c); });
        v1::Model model{};
        if (!v1::Model_Parse(upper, &model) || model == v1::MODEL_UNSPECIFIED)
            return refuse("'" + values[0] + "' is no model");
        change.set_model(model);
        return {};
    }
    const auto value = number<double>(values[0]);
    if (!value) return tl::unexpected(value.error());
    (change.*plainNumber->second)(*value);
    return {};
}

Result<void> spawn(Words words, v1::Command& command) {
    if (auto right = wantWords(words, 1, "spawn"); !right) return right;
    auto group = fromJson<v1::Group>(words[0], "spawn", "a group");
    if (!group) return tl::unexpected(group.error());
    *command.mutable_spawn()->mutable_group() = std::move(*group);
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
    const auto sphere = number<std::uint32_t>(words[0]);
    if (!sphere) return tl::unexpected(sphere.error());
    push.set_sphere(*sphere);
    return numbers(words.subspan(1), push.mutable_impulse());
}

Result<void> seek(Words words, v1::Command& command) {
    if (auto right = wantWords(words, 1, "seek"); !right) return right;
    const auto time = number<double>(words[0]);
    if (!time) return tl::unexpected(time.error());
    command.mutable_seek()->set_time(*time);
    return {};
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

// A command without arguments.
template <auto Make>
Result<void> plain(Words words, v1::Command& command) {
    if (!words.empty()) return refuse("'" + words[0] + "' is one word too many");
    (command.*Make)();
    return {};
}

using Parse = Result<void> (*)(Words, v1::Command&);

const std::map<std::string_view, Parse>& parsers() {
    static const std::map<std::string_view, Parse> table = {
        {"pause", plain<&v1::Command::mutable_pause>},
        {"resume", plain<&v1::Command::mutable_resume>},
        {"reset", plain<&v1::Command::mutable_reset>},
        {"cancel", plain<&v1::Command::mutable_cancel>},
        {"query", plain<&v1::Command::mutable_query>},
        {"step", step},
        {"load", load},
        {"set", set},
        {"spawn", spawn},
        {"push", push},
        {"seek", seek},
        {"record", record},
    };
    return table;
}

}  // namespace

Result<v1::Command> commandFrom(const std::vector<std::string>& words) {
    if (words.empty()) return refuse("nothing was given");
    if (words.size() == 1 && words[0].starts_with('{')) {
        auto command = fromJson<v1::Command>(words[0], "command", "a command");
        if (command && command->kind_case() == v1::Command::KIND_NOT_SET) return refuse("the JSON names no command");
        return command;
    }
    const auto parser = parsers().find(words[0]);
    if (parser == parsers().end()) return refuse("'" + words[0] + "' is no command");
    v1::Command command;
    if (auto parsed = parser->second(Words(words).subspan(1), command); !parsed) return tl::unexpected(parsed.error());
    return command;
}

}  // namespace spherule::client

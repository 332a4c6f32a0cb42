#include "cli/script.h"

#include <cmath>
#include <fstream>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "cli/option_values.h"
#include "client/command_parser.h"
#include "host/from_proto.h"
#include "net/command_rules.h"
#include "scene/load.h"

namespace spherule::cli {

namespace {

constexpr const char* blanks = " \t\r";

tl::unexpected<Error> wrong(const std::string& where, const std::string& what) {
    return fail(ErrorKind::Input, where, what);
}

// An error of a command becomes an error of its line. `field`: the command that has the field in error.where.
tl::unexpected<Error> wrong(const std::string& where, const std::string& field, const Error& error) {
    return wrong(where, error.where.empty() ? error.message : fmt::format("{}.{}", field, error.text()));
}

// Splits a line into words. A word that begins with { is JSON and reaches to the end of the line.
std::vector<std::string> wordsOf(const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t begin = text.find_first_not_of(blanks); begin != std::string::npos;) {
        const std::size_t end = text[begin] == '{' ? std::string::npos : text.find_first_of(blanks, begin);
        words.push_back(text.substr(begin, end - begin));
        begin = end == std::string::npos ? end : text.find_first_not_of(blanks, end);
    }
    return words;
}

Result<sim::Command> commandOf(const std::string& where, const v1::Command& message) {
    const std::string& name = net::nameOf(message);
    if (message.has_set()) {
        if (message.set().has_speed())
            return wrong(where, "'set speed' has no effect: a run goes as fast as it can; leave the line out");
        auto set = host::setOf(message.set());
        if (!set) return wrong(where, name, set.error());
        if (set->goal && *set->goal && (*set->goal)->kind == scene::QualityGoal::Kind::StepTime)
            return wrong(where,
                         "'set auto' with a time per step makes the result depend on the load of the machine; "
                         "give an overlap to hold, such as 0.5%");
        return *set;
    }
    if (message.has_spawn()) return host::spawnOf(message.spawn());
    if (message.has_push()) {
        auto push = host::pushOf(message.push());
        if (!push) return wrong(where, name, push.error());
        return *push;
    }
    if (message.has_remove()) {
        auto remove = host::removeOf(message.remove());
        if (!remove) return wrong(where, name, remove.error());
        return *remove;
    }
    if (message.has_add_obstacle()) return host::changeOf(message.add_obstacle());
    if (message.has_move_obstacle()) return host::changeOf(message.move_obstacle());
    if (message.has_remove_obstacle()) return host::changeOf(message.remove_obstacle());
    if (auto change = host::partCommandOf(message)) return *change;
    return wrong(where, fmt::format("'{}' has no place in a script; it takes set, spawn, remove, push and changes of "
                                    "obstacles, fields, emitters, materials and groups",
                                    name));
}

Result<void> checkId(const std::string& where, std::string_view does, std::uint64_t id, const scene::Scene& scene) {
    if (id < scene.spheres.size()) return {};
    return wrong(where, fmt::format("{} sphere {}, but the scene has {} spheres by then, from 0 on", does, id,
                                    scene.spheres.size()));
}

Result<void> checkRemove(const std::string& where, const sim::Remove& remove, const scene::Scene& scene) {
    for (const std::uint64_t id : remove.spheres)
        if (auto right = checkId(where, "removes", id, scene); !right) return right;
    return {};
}

// Refuses a push of a sphere that does not exist, or that is fixed. `scene` has every sphere that was born by then.
Result<void> checkPush(const std::string& where, const sim::Push& push, const scene::Scene& scene) {
    const auto* const id = std::get_if<std::uint64_t>(&push.target);
    if (id == nullptr) return {};
    if (auto right = checkId(where, "pushes", *id, scene); !right) return right;
    if (scene.spheres[*id].fixed) return wrong(where, fmt::format("pushes sphere {}, which is fixed", *id));
    return {};
}

// Returns the first step of `length` seconds that begins at `time` or after it. Times are sums of steps, with rounding.
std::uint64_t stepAt(double time, double length) {
    constexpr double rounding = 1e-6;
    return static_cast<std::uint64_t>(std::max(0.0, std::ceil(time / length - rounding)));
}

}  // namespace

Result<Script::Line> Script::parse(const std::string& where, const std::string& text) {
    std::vector<std::string> words = wordsOf(text);
    const auto time = secondsOf(words.front(), "");
    if (!time || words.size() < 2)
        return wrong(where, "must have a time and a command, such as: 1.5s set gravity 0 0 -1.6");
    words.erase(words.begin());
    const auto message = client::commandFrom(words);
    if (!message) {
        const Error& error = message.error();
        return wrong(where, error.where == "command" ? error.message : error.text());
    }
    auto command = commandOf(where, *message);
    if (!command) return tl::unexpected(command.error());
    return Line{.where = where,
                .time = *time,
                .name = net::nameOf(*message),
                .command = std::move(*command),
                .spawn = message->spawn()};
}

Result<Script> Script::read(const std::string& path) {
    std::ifstream file(path);
    if (!file)
        return fail(ErrorKind::Input, path, "cannot be read: give a file with a line for each command to --script");
    Script script;
    std::string text;
    for (std::size_t number = 1; std::getline(file, text); ++number) {
        const std::size_t begin = text.find_first_not_of(blanks);
        if (begin == std::string::npos || text[begin] == '#') continue;
        const std::string where = fmt::format("{}:{}", path, number);
        auto line = parse(where, text);
        if (!line) return tl::unexpected(line.error());
        if (!script.lines_.empty() && line->time < script.lines_.back().time)
            return wrong(where, fmt::format("comes at {:g} s, before the line above, at {:g} s; put the lines in the "
                                            "order of their times",
                                            line->time, script.lines_.back().time));
        script.lines_.push_back(std::move(*line));
    }
    if (file.bad()) return fail(ErrorKind::Input, path, "cannot be read to its end: is it a file?");
    return script;
}

Result<void> Script::check(const scene::Scene& scene, double duration) const {
    if (lines_.empty()) return {};
    const auto steps = static_cast<std::uint64_t>(std::llround(duration / scene.step));
    scene::Scene then = scene;
    for (const Line& line : lines_) {
        if (stepAt(line.time, scene.step) >= steps)
            return wrong(line.where, fmt::format("comes at {:g} s, when no step follows; --for ends the run at {:g} s",
                                                 line.time, duration));
        if (const auto* const set = std::get_if<sim::Set>(&line.command)) {
            auto changed = sim::changedBy(*set, std::move(then));
            if (!changed) return wrong(line.where, line.name, changed.error());
            then = std::move(*changed);
        } else if (line.name == "spawn") {
            // Present places do not count: spheres may have moved away by then.
            scene::Scene empty = then;
            empty.spheres.clear();
            const auto added = scene::buildGroup(line.spawn.group(), empty);
            if (!added) return wrong(line.where, line.name, added.error());
            then.spheres.insert(then.spheres.end(), added->begin(), added->end());
        } else if (const auto* const remove = std::get_if<sim::Remove>(&line.command)) {
            if (auto fits = checkRemove(line.where, *remove, then); !fits) return fits;
        } else if (const auto* const push = std::get_if<sim::Push>(&line.command)) {
            if (auto fits = checkPush(line.where, *push, then); !fits) return fits;
        }
    }
    return {};
}

Result<bool> Script::applyDue(sim::Simulation& simulation) {
    const std::size_t first = next_;
    for (; next_ < lines_.size(); ++next_) {
        const Line& line = lines_[next_];
        if (stepAt(line.time, simulation.scene().step) > simulation.steps()) break;
        const auto applied = simulation.apply(line.command);
        if (!applied) return wrong(line.where, line.name, applied.error());
    }
    return next_ > first;
}

}  // namespace spherule::cli

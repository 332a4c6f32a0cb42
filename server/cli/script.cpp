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
#include "scene/group.h"
#include "scene/load.h"
#include "scene/part_changes.h"

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
    if (message.has_set() && message.set().has_speed())
        return wrong(where, "'set speed' has no effect: a run goes as fast as it can; leave the line out");
    // A run has no sessions, and goes on where it is.
    const bool fits = !message.has_reset() && !message.has_pull() && !message.has_release();
    auto command = fits ? host::worldCommandOf(message, 0) : std::nullopt;
    if (!command)
        return wrong(where, fmt::format("'{}' has no place in a script; it takes set, spawn, remove, push and changes "
                                        "of obstacles, fields, emitters, materials and groups",
                                        name));
    if (!*command) return wrong(where, name, command->error());
    const auto* const set = std::get_if<sim::Set>(&**command);
    if (set != nullptr && set->goal && *set->goal && (*set->goal)->kind == scene::QualityGoal::Kind::StepTime)
        return wrong(where,
                     "'set auto' with a time per step makes the result depend on the load of the machine; "
                     "give an overlap to hold, such as 0.5%");
    return *command;
}

// The scene after the commands of a script, as far as it can be known before a run. Refuses a command that is certain
// to fail.
class Forecast {
  public:
    explicit Forecast(const scene::Scene& begin) : scene_(begin) { noticeEmitters(); }

    // `name`: of the command. `time`: s simulated. `spawn`: the message, if it is one.
    Result<void> take(const sim::Command& command, const std::string& name, double time, const v1::Spawn& spawn);

  private:
    Result<void> set(const sim::Set& set);
    Result<void> spawn(const v1::Spawn& message);
    Result<void> remove(const sim::Remove& remove);
    [[nodiscard]] Result<void> push(const sim::Push& push) const;
    void changeObstacle(const sim::ChangeObstacle& change);
    Result<void> changePart(const sim::ChangePart& change, bool ofGroup);
    Result<void> removeGroup(const sim::RemoveGroup& remove);
    void noticeEmitters();
    [[nodiscard]] Result<void> checkId(const char* does, std::uint64_t id) const;

    scene::Scene scene_;
    std::optional<std::uint64_t> known_;  // spheres before the first emitter; nullopt: there is none
    bool groupsKnown_ = true;             // their numbers, and which of them have spheres
    bool ended_ = false;                  // the commands that follow cannot be checked
};

Result<void> Forecast::take(const sim::Command& command, const std::string& name, double time,
                            const v1::Spawn& message) {
    if (ended_) return {};
    scene_.time = time;
    if (name == "spawn") return spawn(message);
    if (const auto* const one = std::get_if<sim::Set>(&command)) return set(*one);
    if (const auto* const one = std::get_if<sim::Remove>(&command)) return remove(*one);
    if (const auto* const one = std::get_if<sim::Push>(&command)) return push(*one);
    if (const auto* const one = std::get_if<sim::ChangePart>(&command)) return changePart(*one, name == "change_group");
    if (const auto* const one = std::get_if<sim::RemoveGroup>(&command)) return removeGroup(*one);
    if (const auto* const one = std::get_if<sim::ChangeObstacle>(&command)) changeObstacle(*one);
    return {};
}

Result<void> Forecast::set(const sim::Set& set) {
    auto changed = sim::changedBy(set, std::move(scene_));
    if (!changed) return tl::unexpected(changed.error());
    scene_ = std::move(*changed);
    return {};
}

// Emitters and sinks change the spheres and the groups at times that only a run shows.
void Forecast::noticeEmitters() {
    if (!scene_.emitters.empty() && !known_) known_ = scene_.spheres.size();
    if (!scene_.emitters.empty() || !scene_.sinks.empty()) groupsKnown_ = false;
}

Result<void> Forecast::spawn(const v1::Spawn& message) {
    // Present places do not count: spheres may have moved away by then.
    scene::Scene empty = scene_;
    empty.spheres.clear();
    if (empty.groups.size() >= scene::maxGroups) scene::removeEmptyGroups(empty);
    const auto added = scene::buildGroup(message.group(), empty);
    if (!added) return tl::unexpected(added.error());
    if (scene_.groups.size() >= scene::maxGroups) scene::removeEmptyGroups(scene_);
    const sim::Spawn made = host::spawnOf(message);
    scene_.groups.push_back(scene::groupOf(*added, made.name, made.look));
    scene_.spheres.insert(scene_.spheres.end(), added->begin(), added->end());
    return {};
}

// The id of a sphere is its number among all spheres there ever were.
Result<void> Forecast::checkId(const char* does, std::uint64_t id) const {
    if (known_ || id < scene_.spheres.size()) return {};
    return fail(
        ErrorKind::Refused, "",
        fmt::format("{} sphere {}, but the scene has {} spheres by then, from 0 on", does, id, scene_.spheres.size()));
}

Result<void> Forecast::remove(const sim::Remove& remove) {
    groupsKnown_ = false;
    for (const std::uint64_t id : remove.spheres)
        if (auto right = checkId("removes", id); !right) return right;
    return {};
}

// Refuses a push of a sphere that does not exist, or that is fixed. Nothing is known of spheres that come after the
// first emitter.
Result<void> Forecast::push(const sim::Push& push) const {
    const auto* const id = std::get_if<std::uint64_t>(&push.target);
    if (id == nullptr) return {};
    if (auto right = checkId("pushes", *id); !right) return right;
    if (*id < known_.value_or(scene_.spheres.size()) && scene_.spheres[*id].fixed)
        return fail(ErrorKind::Refused, "", fmt::format("pushes sphere {}, which is fixed", *id));
    return {};
}

// The run refuses an obstacle that cannot be there, which may depend on its motion until then.
void Forecast::changeObstacle(const sim::ChangeObstacle& change) {
    const std::size_t number = change.obstacle.value_or(static_cast<std::uint32_t>(scene_.obstacles.size()));
    ended_ = change.obstacle && number >= scene_.obstacles.size();
    if (ended_) return;
    auto made = change.make(scene_);
    ended_ = !made;
    if (ended_) return;
    const auto place = scene_.obstacles.begin() + static_cast<std::ptrdiff_t>(number);
    if (!*made)
        scene_.obstacles.erase(place);
    else if (change.obstacle)
        *place = std::move(**made);
    else
        scene_.obstacles.push_back(std::move(**made));
}

Result<void> Forecast::changePart(const sim::ChangePart& change, bool ofGroup) {
    if (ofGroup && !groupsKnown_) return {};
    const auto made = change.make(scene_);
    if (!made) {
        ended_ = true;
        return groupsKnown_ ? Result<void>(tl::unexpected(made.error())) : Result<void>();
    }
    noticeEmitters();
    return {};
}

Result<void> Forecast::removeGroup(const sim::RemoveGroup& remove) {
    const bool known = std::exchange(groupsKnown_, false);
    return known ? scene::checkNumber(remove.number, scene_.groups.size(), "groups") : Result<void>();
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
                .message = *message,
                .command = std::move(*command)};
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
        script.text_ += text + '\n';
    }
    if (file.bad()) return fail(ErrorKind::Input, path, "cannot be read to its end: is it a file?");
    return script;
}

Result<void> Script::check(const scene::Scene& scene, double duration) const {
    if (lines_.empty()) return {};
    const auto steps = static_cast<std::uint64_t>(std::llround(duration / scene.step));
    Forecast then(scene);
    for (const Line& line : lines_) {
        const std::uint64_t step = stepAt(line.time, scene.step);
        if (step >= steps)
            return wrong(line.where, fmt::format("comes at {:g} s, when no step follows; --for ends the run at {:g} s",
                                                 line.time, duration));
        const double time = static_cast<double>(step) * scene.step;
        if (const auto fits = then.take(line.command, line.name, time, line.message.spawn()); !fits)
            return wrong(line.where, line.name, fits.error());
    }
    return {};
}

Result<void> Script::goOnAfter(std::uint64_t commands) {
    if (commands > lines_.size())
        return fail(ErrorKind::Input, "--script",
                    fmt::format("has {} commands, but {} had been carried out before the checkpoint; give the same "
                                "script, with more lines if you like",
                                lines_.size(), commands));
    next_ = static_cast<std::size_t>(commands);
    return {};
}

Result<bool> Script::applyDue(sim::Simulation& simulation, const std::function<void(const v1::Command&)>& carriedOut) {
    const std::size_t first = next_;
    for (; next_ < lines_.size(); ++next_) {
        const Line& line = lines_[next_];
        if (stepAt(line.time, simulation.scene().step) > simulation.steps()) break;
        const auto applied = simulation.apply(line.command);
        if (!applied) return wrong(line.where, line.name, applied.error());
        carriedOut(line.message);
    }
    return next_ > first;
}

}  // namespace spherule::cli

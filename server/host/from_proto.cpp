#include "host/from_proto.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "scene/check.h"
#include "scene/group.h"
#include "scene/obstacle_changes.h"
#include "scene/quality.h"
#include "scene/quality_goal.h"

namespace spherule::host {

namespace {

Result<std::optional<scene::Model>> modelOf(const v1::Set& message) {
    if (!message.has_model()) return std::nullopt;
    if (message.model() <= v1::MODEL_UNSPECIFIED || message.model() > v1::ACCURATE)
        return fail(ErrorKind::Refused, "model",
                    fmt::format("is {}, must be FAST, BALANCED or ACCURATE", static_cast<int>(message.model())));
    return scene::modelOf(message.model());
}

}  // namespace

Result<sim::Set> setOf(const v1::Set& message) {
    sim::Set set;
    if (!message.gravity().empty()) {
        const auto gravity = scene::vectorOf(message.gravity(), "gravity");
        if (!gravity) return tl::unexpected(gravity.error());
        set.gravity = *gravity;
    }
    if (message.has_restitution()) set.restitution = message.restitution();
    if (message.has_friction()) set.friction = message.friction();
    if (message.has_substeps()) set.substeps = message.substeps();
    const auto model = modelOf(message);
    if (!model) return tl::unexpected(model.error());
    set.model = *model;
    if (message.has_auto_()) {
        const auto goal = scene::qualityGoalOf(message.auto_(), "auto");
        if (!goal)
            return fail(ErrorKind::Refused, goal.error().where, goal.error().message, goal.error().cause,
                        goal.error().limits);
        set.goal.emplace(*goal);
    }
    return set;
}

sim::Spawn spawnOf(const v1::Spawn& message) {
    const v1::Group& group = message.group();
    scene::Check unheard;  // buildGroup() reports the same errors
    return {.name = group.name(),
            .look = scene::readLook(unheard, group, "group"),
            .place = [group](const scene::Scene& scene, Progress& progress) {
                return scene::buildGroup(group, scene, &progress);
            }};
}

Result<sim::Remove> removeOf(const v1::Remove& message) {
    sim::Remove remove{.spheres = {message.spheres().begin(), message.spheres().end()}};
    if (message.has_region()) {
        const auto region = scene::boxOf(message.region(), "region");
        if (!region) return tl::unexpected(region.error());
        remove.region = *region;
    }
    if (remove.spheres.empty() && !remove.region)
        return fail(ErrorKind::Refused, "spheres", "are missing: give ids of spheres, or a region");
    return remove;
}

sim::ChangeObstacle changeOf(const v1::AddObstacle& message) {
    return {.make = [message = message.obstacle()](const scene::Scene& scene) {
        return scene::obstacleToAdd(message, scene).map([](scene::Obstacle made) {
            return std::optional(std::move(made));
        });
    }};
}

sim::ChangeObstacle changeOf(const v1::MoveObstacle& message) {
    return {.obstacle = message.obstacle(), .make = [message](const scene::Scene& scene) {
                return scene::movedObstacle(message, scene).map([](scene::Obstacle made) {
                    return std::optional(std::move(made));
                });
            }};
}

sim::ChangeObstacle changeOf(const v1::RemoveObstacle& message) {
    return {.obstacle = message.obstacle(),
            .make = [](const scene::Scene&) -> Result<std::optional<scene::Obstacle>> { return std::nullopt; }};
}

Result<sim::Push> pushOf(const v1::Push& message) {
    sim::Push push;
    const auto impulse = scene::vectorOf(message.impulse(), "impulse");
    if (!impulse) return tl::unexpected(impulse.error());
    push.impulse = *impulse;
    if (message.has_ray()) {
        const auto origin = scene::vectorOf(message.ray().origin(), "ray.origin");
        if (!origin) return tl::unexpected(origin.error());
        const auto direction = scene::vectorOf(message.ray().direction(), "ray.direction");
        if (!direction) return tl::unexpected(direction.error());
        push.target = sim::Ray{.origin = *origin, .direction = *direction};
    } else if (message.target_case() == v1::Push::kSphere) {
        push.target = message.sphere();
    } else {
        return fail(ErrorKind::Refused, "target", "is missing: give a sphere or a ray");
    }
    return push;
}

Result<sim::Pull> pullOf(const v1::Pull& message, std::uint64_t session) {
    const auto point = scene::vectorOf(message.point(), "point");
    if (!point) return tl::unexpected(point.error());
    sim::Pull pull{.session = session, .sphere = message.sphere(), .point = *point};
    if (message.has_stiffness()) pull.stiffness = message.stiffness();
    return pull;
}

namespace {

// Returns the change of a field, an emitter, a material or a group; nullopt for another command.
std::optional<sim::Command> partCommandOf(const v1::Command& command) {
    const auto change = [](const auto& message) -> sim::Command {
        return sim::ChangePart{[message](scene::Scene& scene) { return scene::changePart(scene, message); }};
    };
    switch (command.kind_case()) {
        case v1::Command::kAddField:
            return change(command.add_field());
        case v1::Command::kChangeField:
            return change(command.change_field());
        case v1::Command::kRemoveField:
            return change(command.remove_field());
        case v1::Command::kAddEmitter:
            return change(command.add_emitter());
        case v1::Command::kChangeEmitter:
            return change(command.change_emitter());
        case v1::Command::kRemoveEmitter:
            return change(command.remove_emitter());
        case v1::Command::kAddMaterial:
            return change(command.add_material());
        case v1::Command::kChangeMaterial:
            return change(command.change_material());
        case v1::Command::kRemoveMaterial:
            return change(command.remove_material());
        case v1::Command::kSetPair:
            return change(command.set_pair());
        case v1::Command::kChangeGroup:
            return change(command.change_group());
        case v1::Command::kRemoveGroup:
            return sim::RemoveGroup{command.remove_group().number()};
        default:
            return std::nullopt;
    }
}

template <class Value>
Result<sim::Command> commandFrom(Result<Value> value) {
    return std::move(value).map([](Value one) { return sim::Command(std::move(one)); });
}

}  // namespace

std::optional<Result<sim::Command>> worldCommandOf(const v1::Command& command, std::uint64_t session) {
    switch (command.kind_case()) {
        case v1::Command::kReset:
            return sim::Reset{};
        case v1::Command::kSet:
            return commandFrom(setOf(command.set()));
        case v1::Command::kSpawn:
            return spawnOf(command.spawn());
        case v1::Command::kRemove:
            return commandFrom(removeOf(command.remove()));
        case v1::Command::kAddObstacle:
            return changeOf(command.add_obstacle());
        case v1::Command::kMoveObstacle:
            return changeOf(command.move_obstacle());
        case v1::Command::kRemoveObstacle:
            return changeOf(command.remove_obstacle());
        case v1::Command::kPush:
            return commandFrom(pushOf(command.push()));
        case v1::Command::kPull:
            return commandFrom(pullOf(command.pull(), session));
        case v1::Command::kRelease:
            return sim::Release{session};
        default:
            break;
    }
    if (auto change = partCommandOf(command)) return std::move(*change);
    return std::nullopt;
}

Result<MakeScene> makeSceneOf(const v1::LoadScene& message, const std::string& deviceKind,
                              const scene::Overrides& overrides) {
    if (message.has_scene())
        return [scene = message.scene(), overrides](Progress& progress) {
            return scene::build(scene, overrides, &progress).map_error([](Error error) {
                if (!error.where.empty()) error.where = "scene." + error.where;
                return error;
            });
        };
    if (message.source_case() != v1::LoadScene::kName)
        return fail(ErrorKind::Refused, "", "load needs a name or a scene");
    const auto names = scene::names();
    if (std::ranges::find(names, message.name()) == names.end())
        return fail(ErrorKind::Refused, "name",
                    fmt::format("is {}; known are {}", scene::shown(message.name()), fmt::join(names, ", ")),
                    Cause::NoSuchScene);
    return [name = message.name(), deviceKind, overrides](Progress& progress) {
        return scene::load(name, deviceKind, overrides, &progress);
    };
}

}  // namespace spherule::host

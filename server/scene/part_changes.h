#pragma once

#include <cstdint>

#include "core/result.h"
#include "scene/scene.h"

namespace spherule::v1 {
class AddEmitter;
class AddField;
class AddMaterial;
class ChangeEmitter;
class ChangeField;
class ChangeGroup;
class ChangeMaterial;
class RemoveEmitter;
class RemoveField;
class RemoveMaterial;
class SetPair;
}  // namespace spherule::v1

// Changes of the fields, emitters, materials and groups of a scene while it runs. Obstacles: obstacle_changes.h.
namespace spherule::scene {

// The part of a scene that a change has added, changed or removed.
struct PartChange {
    enum class Part : std::uint8_t { Fields, Emitters, Materials, Pairs, Groups };
    enum class Kind : std::uint8_t { Added, Changed, Removed };
    Part part{};
    Kind kind{};
    std::uint32_t number = 0;  // among the parts of its kind; of a removed part: before
};

// Each carries out the change of the message at scene.time, and checks the whole scene. After an error the scene must
// not be used any more. The errors' `where` begins at the message, or at the scene if another part of it does not suit.
Result<PartChange> changePart(Scene& scene, const v1::AddField& message);
Result<PartChange> changePart(Scene& scene, const v1::ChangeField& message);
Result<PartChange> changePart(Scene& scene, const v1::RemoveField& message);
Result<PartChange> changePart(Scene& scene, const v1::AddEmitter& message);
Result<PartChange> changePart(Scene& scene, const v1::ChangeEmitter& message);
Result<PartChange> changePart(Scene& scene, const v1::RemoveEmitter& message);
Result<PartChange> changePart(Scene& scene, const v1::AddMaterial& message);
Result<PartChange> changePart(Scene& scene, const v1::ChangeMaterial& message);
Result<PartChange> changePart(Scene& scene, const v1::RemoveMaterial& message);
Result<PartChange> changePart(Scene& scene, const v1::SetPair& message);
Result<PartChange> changePart(Scene& scene, const v1::ChangeGroup& message);

// Refuses a number that none of `count` parts has. `of`: their name, such as "fields".
Result<void> checkNumber(std::uint32_t number, std::size_t count, const char* of);

// Returns true if two groups differ at most in the number of their spheres.
bool sameGroup(const Group& one, const Group& other);

// Returns the number of the emitter whose spheres are of the group; nullopt if there is none.
std::optional<std::size_t> emitterOf(const Scene& scene, std::size_t group);

// Removes a group without spheres and without an emitter. The numbers of the groups behind it fall by one.
void removeGroup(Scene& scene, std::size_t number);

}  // namespace spherule::scene

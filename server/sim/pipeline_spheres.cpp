// The part of Pipeline that adds, removes and pushes spheres.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "core/memory.h"
#include "sim/pipeline.h"

namespace spherule::sim {

Result<void> Pipeline::growSpheres(std::uint32_t room, const scene::Scene& scene) {
    Plan larger = plan_;
    larger.room = room;
    std::uint64_t onHost = 0;
    for (const ArraySpec& spec : plan_.arrays) {
        const std::uint64_t bytes = larger.bytesFor(spec.array, scene);
        if (bytes > spec.bytes) onHost += device_.hostBytes(bytes, typeOf(spec.array).words);
    }
    const auto claim = memory::Claim::make("", fmt::format("arrays of {} spheres", room), onHost);
    if (!claim) return tl::unexpected(claim.error());
    for (ArraySpec& spec : plan_.arrays) {
        const std::uint64_t bytes = larger.bytesFor(spec.array, scene);
        if (bytes <= spec.bytes) continue;
        auto made = device_.createBuffer(nameOf(spec.array), bytes, typeOf(spec.array).words);
        if (!made) return tl::unexpected(made.error());
        device_.copy(buffer(spec.array), 0, spec.bytes, **made, 0);
        spec.bytes = bytes;
        setBuffer(spec.array, std::move(*made));
        device_.finish();  // the driver frees the array before the next one is made
    }
    plan_.room = room;
    placeFarSlot();
    if (plan_.grid.hasMovers) requestRebuild();  // pairs of movers have the old far slot
    return {};
}

// Returns the bytes of a sphere in an array with elements for each sphere.
std::size_t Pipeline::rowBytes(Array array) const {
    const ArrayType& type = typeOf(array);
    return type.elementBytes * (type.extent == Extent::RememberedWall ? plan_.maxWallHistory : 1);
}

// Sets rows of such an array to zero.
void Pipeline::clearRows(Array array, std::size_t first, std::size_t count) {
    const std::vector<std::byte> zeros(count * rowBytes(array));
    device_.upload(buffer(array), first * rowBytes(array), zeros);
}

namespace {

// Calls `run` with the first handle, the number and the place in `handles` of each run of consecutive handles.
template <class Run>
void forRuns(std::span<const std::uint32_t> handles, Run run) {
    for (std::size_t begin = 0, end = 0; begin < handles.size(); begin = end) {
        for (end = begin + 1; end < handles.size() && handles[end] == handles[end - 1] + 1;) ++end;
        run(handles[begin], end - begin, begin);
    }
}

}  // namespace

void Pipeline::append(const State& born, std::span<const std::uint8_t> materials,
                      std::span<const std::uint32_t> handles) {
    const std::uint32_t first = plan_.spheres;
    for (const ArraySpec& spec : plan_.arrays) {
        const ArrayType& type = typeOf(spec.array);
        if (!type.cleared || (type.extent != Extent::Sphere && type.extent != Extent::RememberedWall)) continue;
        if (type.byId)
            forRuns(handles, [&](std::uint32_t handle, std::size_t count, std::size_t) {
                clearRows(spec.array, handle, count);
            });
        else
            clearRows(spec.array, first, handles.size());
    }
    writeColumns(born, first);
    std::vector<std::uint32_t> words(handles.begin(), handles.end());
    std::vector<std::uint32_t> slots(handles.size());
    std::iota(slots.begin(), slots.end(), first);
    std::vector<glm::vec4> rest;
    for (const glm::vec4& place : born.position) rest.emplace_back(glm::vec3(place), MOVED_AWAY);
    forRuns(handles, [&](std::uint32_t handle, std::size_t count, std::size_t at) {
        if (plan_.has(Array::SlotOf)) write<std::uint32_t>(Array::SlotOf, std::span(slots).subspan(at, count), handle);
        if (plan_.has(Array::RestReference))
            write<glm::vec4>(Array::RestReference, std::span(rest).subspan(at, count), handle);
    });
    for (std::size_t k = 0; k < words.size(); ++k) words[k] |= std::uint32_t{materials[k]} << idBits;
    write<std::uint32_t>(Array::IdAndMaterial, words, first);
    setSpheres(first + static_cast<std::uint32_t>(handles.size()));
    const bool awake = std::ranges::all_of(born.velocity, [](const glm::vec4& v) { return v.w > 0; });
    if (!plan_.grid.hasMovers || !awake) {
        requestRebuild();
        return;
    }
    // They are in no list yet, and become movers.
    const std::vector<glm::vec4> nowhere(handles.size(), glm::vec4(1e18F, 0, 0, 0));
    write<glm::vec4>(Array::ListReference, nowhere, first);
    unlistedBirths_ += static_cast<std::uint32_t>(handles.size());
    write<std::uint32_t>(Array::Counters, std::span<const std::uint32_t>(&unlistedBirths_, 1), COUNTER_BORN);
    expectRebuild();
}

Result<void> Pipeline::remove(std::span<const std::uint32_t> handles) {
    if (auto made = makeSlotOf(); !made) return made;
    // The lists tell which sleepers rest on the spheres that go.
    if (listsPending_ && plan_.features.has(Feature::Contacts)) rebuildLists();
    std::vector<bool> gone(plan_.room);
    for (const std::uint32_t handle : handles) gone[handle] = true;
    const auto words = read<std::uint32_t>(Array::IdAndMaterial, plan_.spheres);
    if (plan_.features.has(Feature::Sleep)) wakeNeighbours(gone, words);
    const std::uint32_t left = plan_.spheres - static_cast<std::uint32_t>(handles.size());
    if (plan_.features.has(Feature::Contacts)) {
        auto position = read<glm::vec4>(Array::Position, plan_.spheres);
        for (std::size_t slot = 0; slot < words.size(); ++slot)
            if (gone[words[slot] & idMask]) position[slot].w = -std::abs(position[slot].w);
        write<glm::vec4>(Array::Position, position);
        requestRebuild();
        rebuildLists();
        write<std::uint32_t>(Array::Counters, std::span<const std::uint32_t>(&left, 1), COUNTER_SORTED);
    } else {
        std::vector<std::uint32_t> slots;
        for (std::uint32_t slot = 0; slot < words.size(); ++slot)
            if (gone[words[slot] & idMask]) slots.push_back(slot);
        moveLastInto(std::move(slots));
    }
    setSpheres(left);
    return {};
}

Result<void> Pipeline::makeSlotOf() {
    return makeMissing(Array::SlotOf, plan_.room);
}

// Makes an array unless the plan has it.
Result<void> Pipeline::makeMissing(Array array, std::uint64_t elements) {
    if (plan_.has(array)) return {};
    const ArraySpec spec{array, elements * typeOf(array).elementBytes};
    auto made = device_.createBuffer(nameOf(array), spec.bytes, typeOf(array).words);
    if (!made) return tl::unexpected(made.error());
    setBuffer(array, std::move(*made));
    plan_.arrays.push_back(spec);
    return {};
}

// Lets the spheres that go wake their neighbours, as if they moved away. Fixed ones get a mass for it.
void Pipeline::wakeNeighbours(const std::vector<bool>& gone, std::span<const std::uint32_t> words) {
    auto velocity = read<glm::vec4>(Array::Velocity, plan_.spheres);
    auto rest = read<glm::vec4>(Array::RestReference);
    for (std::size_t slot = 0; slot < words.size(); ++slot) {
        if (!gone[words[slot] & idMask]) continue;
        velocity[slot].w = velocity[slot].w == 0 ? 1 : std::abs(velocity[slot].w);
        rest[words[slot] & idMask].w = MOVED_AWAY;
    }
    write<glm::vec4>(Array::Velocity, velocity);
    write<glm::vec4>(Array::RestReference, rest);
    run(substep_, LaunchSet::Waking);
}

// Without contacts, nothing sorts the columns: the last spheres move to the places of those that go.
void Pipeline::moveLastInto(std::vector<std::uint32_t> slots) {
    std::vector<std::uint32_t> from(plan_.spheres);
    std::iota(from.begin(), from.end(), 0U);
    for (auto slot = slots.rbegin(); slot != slots.rend(); ++slot) {
        from[*slot] = from.back();
        from.pop_back();
    }
    for (const ArraySpec& spec : plan_.arrays) {
        if (!typeOf(spec.array).sorted) continue;
        const std::size_t row = rowBytes(spec.array);
        std::vector<std::byte> before(plan_.spheres * row);
        device_.download(buffer(spec.array), 0, before);
        std::vector<std::byte> after(from.size() * row);
        for (std::size_t slot = 0; slot < from.size(); ++slot)
            std::copy_n(before.begin() + static_cast<std::ptrdiff_t>(from[slot] * row), row,
                        after.begin() + static_cast<std::ptrdiff_t>(slot * row));
        device_.upload(buffer(spec.array), 0, after);
    }
    const auto words = read<std::uint32_t>(Array::IdAndMaterial, from.size());
    std::vector<std::uint32_t> slotOf(plan_.room);
    for (std::uint32_t slot = 0; slot < words.size(); ++slot) slotOf[words[slot] & idMask] = slot;
    write<std::uint32_t>(Array::SlotOf, slotOf);
}

std::uint32_t Pipeline::slotOf(std::uint32_t handle) {
    std::uint32_t slot = handle;
    if (plan_.has(Array::SlotOf))
        device_.download(buffer(Array::SlotOf), handle * sizeof slot, std::as_writable_bytes(std::span(&slot, 1)));
    return slot;
}

glm::vec4 Pipeline::velocityOf(std::uint32_t handle) {
    return rowOf<glm::vec4>(handle, Array::Velocity);
}

void Pipeline::applyImpulse(std::uint32_t handle, glm::vec3 impulse) {
    const std::uint32_t slot = slotOf(handle);
    glm::vec4 velocity = velocityOf(handle);
    velocity.w = std::abs(velocity.w);
    const glm::vec4 change(impulse * velocity.w, 0);
    const glm::vec4 changed = velocity + change;
    write<glm::vec4>(Array::Velocity, std::span<const glm::vec4>(&changed, 1), slot);
    if (plan_.has(Array::UnheldVelocity)) {  // what its contacts hold stays
        const glm::vec4 unheld = rowOf<glm::vec4>(handle, Array::UnheldVelocity) + change;
        write<glm::vec4>(Array::UnheldVelocity, std::span<const glm::vec4>(&unheld, 1), slot);
    }
    awaitSpeeds();
    if (!plan_.features.has(Feature::Sleep)) return;
    // A slow push must also wake the sleepers that the sphere touches.
    constexpr float movedAway = MOVED_AWAY;
    device_.upload(buffer(Array::RestReference), handle * sizeof(glm::vec4) + 3 * sizeof movedAway,
                   std::as_bytes(std::span(&movedAway, 1)));
}

}  // namespace spherule::sim

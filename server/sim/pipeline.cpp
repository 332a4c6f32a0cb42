#include "sim/pipeline.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "core/memory.h"
#include "scene/load.h"
#include "scene/materials.h"
#include "sim/shaders.h"

namespace spherule::sim {

namespace {

constexpr std::uint32_t workgroup = 64;
constexpr std::uint32_t maxGroupsPerAxis = 32768;
constexpr std::uint32_t idBits = 24;  // of a word of idAndMaterial
constexpr std::uint32_t idMask = (1U << idBits) - 1;
static_assert(scene::maxSpheres <= idMask);
static_assert(scene::maxMaterials <= 1U << (32 - idBits));

// Returns groups x, y, z for `invocations`, as the kernels index them, and `invocations`.
glm::uvec4 groupsFor(std::uint32_t invocations) {
    const std::uint32_t groups = (invocations + workgroup - 1) / workgroup;
    const std::uint32_t x = std::min(groups, maxGroupsPerAxis);
    return {x, x == 0 ? 1 : (groups + x - 1) / x, 1, invocations};
}

// Adds the memory of the whole scene to a refusal, because the device refuses a single array.
Error withTotalMemory(Error error, const Plan& plan) {
    if (error.kind == ErrorKind::Refused)
        error.message +=
            fmt::format(" (the scene needs {:.1f} MiB in all)", static_cast<double>(plan.bytes()) / (1 << 20));
    return error;
}

// Moves a position back into the bounds along periodic axes, as shaders/wrap_positions.comp does.
void wrap(glm::vec4& position, glm::ivec3& images, const glm::dvec3& periods) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto half = static_cast<float>(0.5 * periods[axis]);
        float& p = position[axis];
        if (half == 0 || (p >= -half && p < half) || !std::isfinite(p)) continue;
        const float turns = std::floor(p / (2 * half) + 0.5F);
        p -= turns * (2 * half);
        images[axis] += static_cast<int>(std::clamp(turns, -1e6F, 1e6F));
    }
}

bool growsWithPairs(Array array) {
    return typeOf(array).extent == Extent::Pair || typeOf(array).extent == Extent::PairTwice;
}

}  // namespace

State inIdOrder(const SlotState& slots, const Population& population) {
    const std::size_t spheres = slots.idAndMaterial.size();
    const std::vector<std::uint32_t> ranks = population.ranksByHandle();
    State state;
    if (!population.plain()) {
        state.ids.resize(spheres);
        for (std::uint32_t rank = 0; rank < spheres; ++rank) state.ids[rank] = population.idAt(rank);
    }
    state.position.resize(spheres);
    state.velocity.resize(spheres);
    state.spin.resize(spheres);
    if (!slots.images.empty()) state.images.resize(spheres);
    for (std::size_t slot = 0; slot < spheres; ++slot) {
        const std::uint32_t handle = slots.idAndMaterial[slot] & idMask;
        const std::uint32_t rank = ranks.empty() ? handle : ranks[handle];
        state.position[rank] = slots.position[slot];
        state.velocity[rank] = slots.velocity[slot];
        if (!slots.images.empty()) {
            state.images[rank] = glm::ivec3(slots.images[handle]);
            wrap(state.position[rank], state.images[rank], slots.periods);
        }
        if (!slots.angularVelocity.empty()) state.spin[rank] = glm::vec4(glm::vec3(slots.angularVelocity[slot]), 0);
    }
    return state;
}

Result<std::vector<Array>> arraysFor(const LaunchSpec& launch, const compute::Kernel& kernel) {
    const auto wrong = [&](const std::string& message) {
        return fail(ErrorKind::NoDevice, std::string(launch.kernel), message);
    };
    const auto declared = kernel.buffers();
    for (const Alias& alias : launch.aliases)
        if (std::ranges::find(declared, alias.buffer, &compute::BufferDeclaration::name) == declared.end())
            return wrong(fmt::format("is launched with an alias for {}, which it does not declare", alias.buffer));
    std::vector<Array> arrays;
    for (const auto& [type, name] : declared) {
        const auto alias = std::ranges::find(launch.aliases, name, &Alias::buffer);
        const auto array = alias != launch.aliases.end() ? std::optional(alias->array) : arrayNamed(name);
        if (!array)
            return wrong(fmt::format("declares the buffer {}, but sim/arrays.def has no array of that name", name));
        if (typeOf(*array).type != type)
            return wrong(fmt::format("declares the buffer {} as {}; the array {} has elements of type {}", name, type,
                                     nameOf(*array), typeOf(*array).type));
        arrays.push_back(*array);
    }
    return arrays;
}

Pipeline::Pipeline(compute::Device& device, Plan plan) : device_(device), plan_(std::move(plan)) {
    for (const auto* launches : {&plan_.substep, &plan_.newSubstep, &plan_.statistics, &plan_.stepEnd})
        for (const LaunchSpec& launch : *launches)
            if (std::ranges::find(kernelFiles_, launch.kernel) == kernelFiles_.end())
                kernelFiles_.push_back(launch.kernel);
}

Result<bool> Pipeline::makeNext() {
    Result<void> done;
    if (!absent_)
        done = makeSmallArrays();
    else if (arraysMade_ < plan_.arrays.size())
        done = makeArray(plan_.arrays[arraysMade_]);
    else if (kernels_.size() < kernelFiles_.size())
        done = makeKernel(kernelFiles_[kernels_.size()]);
    else if (substep_.empty())
        done = bindAll();
    else
        return false;
    if (!done) return tl::unexpected(done.error());
    return true;
}

double Pipeline::shareMade() const {
    const std::size_t all = plan_.arrays.size() + kernelFiles_.size();
    return all > 0 ? static_cast<double>(arraysMade_ + kernels_.size()) / static_cast<double>(all) : 1;
}

void Pipeline::setBuffer(Array array, std::unique_ptr<compute::Buffer> made) {
    const auto index = static_cast<std::size_t>(array);
    owned_[index] = std::move(made);
    buffers_[index] = owned_[index].get();
}

Result<void> Pipeline::makeSmallArrays() {
    auto parameters = device_.createBuffer("parameters", sizeof(layout::Parameters), layout::wordsOf("Parameters"));
    if (!parameters) return tl::unexpected(parameters.error());
    auto absent = device_.createBuffer("absent", 64);
    if (!absent) return tl::unexpected(absent.error());
    parameters_ = std::move(*parameters);
    absent_ = std::move(*absent);
    buffers_.fill(absent_.get());
    return {};
}

Result<void> Pipeline::makeArray(const ArraySpec& spec) {
    auto made = device_.createBuffer(nameOf(spec.array), spec.bytes, typeOf(spec.array).words);
    if (!made) return tl::unexpected(withTotalMemory(made.error(), plan_));
    setBuffer(spec.array, std::move(*made));
    ++arraysMade_;
    if (spec.array == Array::DispatchSizes) writeDispatchSizes();
    return {};
}

void Pipeline::writeDispatchSizes() {
    std::vector<glm::uvec4> rows;
    for (const std::uint32_t invocations : plan_.dispatchSizes) rows.push_back(groupsFor(invocations));
    write<glm::uvec4>(Array::DispatchSizes, rows);
}

Result<void> Pipeline::makeKernel(std::string_view file) {
    auto kernel = device_.createKernel(shaders(), file, definesFor(plan_.features));
    // The device is at fault, not the user's scene.
    if (!kernel) return fail(ErrorKind::NoDevice, kernel.error().where, kernel.error().message);
    kernels_.push_back(std::move(*kernel));
    return {};
}

Result<void> Pipeline::bindAll() {
    for (const auto& [launches, bound] :
         {std::pair(&plan_.substep, &substep_),
          {&plan_.newSubstep, &newSubstep_},
          {&plan_.statistics, &statistics_},
          {&plan_.stepEnd, &stepEnd_}})
        for (const LaunchSpec& spec : *launches) {
            const auto index = std::ranges::find(kernelFiles_, spec.kernel) - kernelFiles_.begin();
            const compute::Kernel& kernel = *kernels_[static_cast<std::size_t>(index)];
            auto arrays = arraysFor(spec, kernel);
            if (!arrays) return tl::unexpected(arrays.error());
            bound->push_back({.spec = &spec, .kernel = &kernel, .arrays = std::move(*arrays)});
        }
    return {};
}

void Pipeline::setParameters(layout::Parameters parameters) {
    const float before = std::exchange(substepLength_, parameters.substep);
    parameters.substepRatio = before > 0 ? parameters.substep / before : 1;
    device_.upload(*parameters_, 0, std::as_bytes(std::span(&parameters, 1)));
    if (parameters.substepRatio != 1) run(newSubstep_, LaunchSet::Substep);
}

void Pipeline::upload(const State& state, std::span<const std::uint8_t> materials,
                      std::span<const std::uint32_t> handles) {
    setSpheres(state.count());
    // Clears all other data of the spheres that were in these slots.
    for (const ArraySpec& spec : plan_.arrays)
        if (typeOf(spec.array).cleared) device_.fill(buffer(spec.array), 0);
    write<glm::vec4>(Array::Position, state.position);
    write<glm::vec4>(Array::Velocity, state.velocity);
    if (plan_.has(Array::AngularVelocity)) write<glm::vec4>(Array::AngularVelocity, state.spin);
    if (plan_.has(Array::Images) && !state.images.empty()) {
        std::vector<glm::uvec4> images(plan_.room);
        for (std::uint32_t rank = 0; rank < state.count(); ++rank)
            images[handles.empty() ? rank : handles[rank]] = glm::uvec4(glm::uvec3(state.images[rank]), 0U);
        write<glm::uvec4>(Array::Images, images);
    }
    std::vector<std::uint32_t> words(state.count());
    std::iota(words.begin(), words.end(), 0U);
    if (plan_.has(Array::SlotOf)) {
        std::vector<std::uint32_t> slots(words);
        if (!handles.empty()) {
            slots.resize(plan_.room);
            for (std::uint32_t slot = 0; slot < state.count(); ++slot) slots[handles[slot]] = slot;
        }
        write<std::uint32_t>(Array::SlotOf, slots);
    }
    if (!handles.empty()) words.assign(handles.begin(), handles.end());
    for (std::uint32_t slot = 0; slot < state.count(); ++slot) words[slot] |= std::uint32_t{materials[slot]} << idBits;
    write<std::uint32_t>(Array::IdAndMaterial, words);
    std::array<std::uint32_t, COUNTER_WORDS> counters{};
    counters[COUNTER_REBUILD] = 1;
    write<std::uint32_t>(Array::Counters, counters);
    listsPending_ = true;
}

SlotState Pipeline::download() {
    SlotState slots;
    download(slots);
    return slots;
}

void Pipeline::download(SlotState& slots) {
    readInto(slots.position, Array::Position, plan_.spheres);
    readInto(slots.velocity, Array::Velocity, plan_.spheres);
    readInto(slots.angularVelocity, Array::AngularVelocity, plan_.spheres);
    readInto(slots.idAndMaterial, Array::IdAndMaterial, plan_.spheres);
    readInto(slots.images, Array::Images);
    slots.periods = plan_.periods;
}

std::uint32_t Pipeline::slotOf(std::uint32_t handle) {
    std::uint32_t slot = handle;
    if (plan_.has(Array::SlotOf))
        device_.download(buffer(Array::SlotOf), handle * sizeof slot, std::as_writable_bytes(std::span(&slot, 1)));
    return slot;
}

glm::vec4 Pipeline::velocityOf(std::uint32_t handle) {
    glm::vec4 velocity;
    device_.download(buffer(Array::Velocity), slotOf(handle) * sizeof velocity,
                     std::as_writable_bytes(std::span(&velocity, 1)));
    return velocity;
}

void Pipeline::applyImpulse(std::uint32_t handle, glm::vec3 impulse) {
    const std::uint32_t slot = slotOf(handle);
    glm::vec4 velocity = velocityOf(handle);
    velocity.w = std::abs(velocity.w);
    velocity += glm::vec4(impulse * velocity.w, 0);
    write<glm::vec4>(Array::Velocity, std::span<const glm::vec4>(&velocity, 1), slot);
    if (!plan_.features.has(Feature::Sleep)) return;
    // A slow push must also wake the sleepers that the sphere touches.
    constexpr float movedAway = MOVED_AWAY;
    device_.upload(buffer(Array::RestReference), handle * sizeof(glm::vec4) + 3 * sizeof movedAway,
                   std::as_bytes(std::span(&movedAway, 1)));
}

void Pipeline::wakeAll() {
    if (!plan_.features.has(Feature::Sleep)) return;
    auto velocity = read<glm::vec4>(Array::Velocity);
    for (glm::vec4& one : velocity) one.w = std::abs(one.w);
    write<glm::vec4>(Array::Velocity, velocity);
}

// Copies in parts: a copy of the whole would need as much host memory again.
void Pipeline::copy(compute::Buffer& from, std::size_t begin, std::size_t bytes, compute::Buffer& to,
                    std::size_t toBegin) {
    constexpr std::size_t most = 16U << 20U;
    std::vector<std::byte> part;
    for (std::size_t done = 0; done < bytes; done += part.size()) {
        part.resize(std::min(most, bytes - done));
        device_.download(from, begin + done, part);
        device_.upload(to, toBegin + done, part);
    }
}

Result<void> Pipeline::growPairs(std::uint32_t capacity) {
    const auto grownBytes = [&](const ArraySpec& spec) { return spec.bytes / plan_.pairCapacity * capacity; };
    std::uint64_t onHost = 0;
    for (const ArraySpec& spec : plan_.arrays)
        if (growsWithPairs(spec.array)) onHost += device_.hostBytes(grownBytes(spec), typeOf(spec.array).words);
    const auto claim = memory::Claim::make("", fmt::format("lists of {} pairs", capacity), onHost);
    if (!claim) return tl::unexpected(claim.error());
    std::vector<std::unique_ptr<compute::Buffer>> grown;
    for (ArraySpec& spec : plan_.arrays) {
        if (!growsWithPairs(spec.array)) continue;
        auto made = device_.createBuffer(nameOf(spec.array), grownBytes(spec), typeOf(spec.array).words);
        if (!made) return tl::unexpected(made.error());
        // The rebuild reads the old lists once more.
        const std::size_t halves = typeOf(spec.array).extent == Extent::PairTwice ? 2 : 1;
        const std::size_t half = spec.bytes / halves;
        for (std::size_t k = 0; k < halves; ++k)
            copy(buffer(spec.array), k * half, half, **made, k * (*made)->bytes() / halves);
        grown.push_back(std::move(*made));
    }
    auto next = grown.begin();
    for (ArraySpec& spec : plan_.arrays) {
        if (!growsWithPairs(spec.array)) continue;
        spec.bytes = (*next)->bytes();
        setBuffer(spec.array, std::move(*next++));
    }
    plan_.setPairCapacity(capacity);
    requestRebuild();
    return {};
}

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
        copy(buffer(spec.array), 0, spec.bytes, **made, 0);
        spec.bytes = bytes;
        setBuffer(spec.array, std::move(*made));
    }
    plan_.room = room;
    return {};
}

void Pipeline::setSpheres(std::uint32_t count) {
    plan_.setSpheres(count);
    if (plan_.has(Array::DispatchSizes)) writeDispatchSizes();
}

void Pipeline::requestRebuild() {
    const std::uint32_t rebuild = 1;
    write<std::uint32_t>(Array::Counters, std::span<const std::uint32_t>(&rebuild, 1), COUNTER_REBUILD);
    listsPending_ = true;
}

// The next lists of overfull cells depend on two counters, which must count only the lists of substeps.
void Pipeline::rebuildLists() {
    const auto before = read<std::uint32_t>(Array::Counters);
    run(substep_, LaunchSet::Rebuild);
    for (const std::uint32_t word : {COUNTER_REBUILDS, COUNTER_SUBSTEPS})
        write<std::uint32_t>(Array::Counters, std::span<const std::uint32_t>(&before[word], 1), word);
    listsPending_ = false;
}

// Sets rows of an array with elements for each sphere to zero.
void Pipeline::clearRows(const ArraySpec& spec, std::size_t first, std::size_t count) {
    const std::vector<std::byte> zeros(count * rowBytes(spec));
    device_.upload(buffer(spec.array), first * rowBytes(spec), zeros);
}

void Pipeline::append(const State& born, std::span<const std::uint8_t> materials,
                      std::span<const std::uint32_t> handles) {
    const std::uint32_t first = plan_.spheres;
    for (const ArraySpec& spec : plan_.arrays) {
        const ArrayType& type = typeOf(spec.array);
        if (!type.cleared || (type.extent != Extent::Sphere && type.extent != Extent::RememberedWall)) continue;
        if (type.byId)
            for (const std::uint32_t handle : handles) clearRows(spec, handle, 1);
        else
            clearRows(spec, first, handles.size());
    }
    write<glm::vec4>(Array::Position, born.position, first);
    write<glm::vec4>(Array::Velocity, born.velocity, first);
    if (plan_.has(Array::AngularVelocity)) write<glm::vec4>(Array::AngularVelocity, born.spin, first);
    std::vector<std::uint32_t> words(handles.begin(), handles.end());
    for (std::uint32_t k = 0; k < words.size(); ++k) {
        const std::uint32_t slot = first + k;
        if (plan_.has(Array::SlotOf))
            write<std::uint32_t>(Array::SlotOf, std::span<const std::uint32_t>(&slot, 1), handles[k]);
        if (plan_.has(Array::RestReference)) {
            const glm::vec4 rest(glm::vec3(born.position[k]), MOVED_AWAY);
            write<glm::vec4>(Array::RestReference, std::span<const glm::vec4>(&rest, 1), handles[k]);
        }
        words[k] |= std::uint32_t{materials[k]} << idBits;
    }
    write<std::uint32_t>(Array::IdAndMaterial, words, first);
    setSpheres(first + static_cast<std::uint32_t>(handles.size()));
    requestRebuild();
}

Result<void> Pipeline::remove(std::span<const std::uint32_t> handles) {
    if (auto made = makeSlotOf(); !made) return made;
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
    } else {
        std::vector<std::uint32_t> slots;
        for (std::uint32_t slot = 0; slot < words.size(); ++slot)
            if (gone[words[slot] & idMask]) slots.push_back(slot);
        moveLastInto(std::move(slots));
    }
    setSpheres(left);
    return {};
}

// Makes the array SlotOf: in scenes without contacts, slots are handles until a sphere is removed.
Result<void> Pipeline::makeSlotOf() {
    if (plan_.has(Array::SlotOf)) return {};
    const ArraySpec spec{Array::SlotOf, std::uint64_t{plan_.room} * typeOf(Array::SlotOf).elementBytes};
    auto made = device_.createBuffer(nameOf(spec.array), spec.bytes, typeOf(spec.array).words);
    if (!made) return tl::unexpected(made.error());
    setBuffer(spec.array, std::move(*made));
    plan_.arrays.push_back(spec);
    return {};
}

// Lets the spheres that go wake their neighbours, as if they moved away.
void Pipeline::wakeNeighbours(const std::vector<bool>& gone, std::span<const std::uint32_t> words) {
    auto velocity = read<glm::vec4>(Array::Velocity, plan_.spheres);
    auto rest = read<glm::vec4>(Array::RestReference);
    for (std::size_t slot = 0; slot < words.size(); ++slot) {
        if (!gone[words[slot] & idMask]) continue;
        velocity[slot].w = std::abs(velocity[slot].w);
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
        const std::size_t row = rowBytes(spec);
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

void Pipeline::substep(bool observed) {
    run(substep_, observed ? LaunchSet::ObservedSubstep : LaunchSet::Substep);
    listsPending_ = false;
    impactsPending_ = impactsPending_ || observed;
}

std::vector<glm::vec4> Pipeline::takeImpacts() {
    if (!impactsPending_ || !plan_.has(Array::Impacts)) return {};
    auto taken = read<glm::vec4>(Array::Impacts);
    device_.fill(buffer(Array::Impacts), 0);
    impactsPending_ = false;
    return taken;
}

void Pipeline::runStatistics() {
    if (listsPending_) {
        rebuildLists();  // reading statistics does not change the simulation
    }
    run(statistics_, LaunchSet::Substep);
}

std::vector<std::uint32_t> Pipeline::contactCounts() {
    std::vector<std::uint32_t> counts(plan_.room);
    if (!plan_.has(touchingArray)) return counts;
    runStatistics();
    const auto words = read<std::uint32_t>(Array::IdAndMaterial);
    const auto touching = read<std::uint32_t>(touchingArray);
    for (std::uint32_t slot = 0; slot < plan_.spheres; ++slot) counts[words[slot] & idMask] = touching[slot];
    return counts;
}

void Pipeline::run(const std::vector<BoundLaunch>& launches, LaunchSet set) {
    const auto skipped = [set](const LaunchSpec& spec) {
        const bool rebuild = spec.pass == Pass::Grid || spec.pass == Pass::Lists || spec.pass == Pass::ContactMemory;
        switch (set) {
            case LaunchSet::Rebuild:
                return !rebuild;
            case LaunchSet::Waking:
                return !spec.waking;
            case LaunchSet::Substep:
                return spec.observing;
            case LaunchSet::ObservedSubstep:
                break;
        }
        return false;
    };
    std::optional<Pass> timed;
    std::array<compute::Buffer*, compute::maxKernelBuffers> bound{};
    for (const BoundLaunch& one : launches) {
        const LaunchSpec& spec = *one.spec;
        if (skipped(spec)) continue;
        if (timed != spec.pass) {
            if (timed) device_.endTimer();
            device_.beginTimer(static_cast<unsigned>(spec.pass));
            timed = spec.pass;
        }
        for (std::size_t slot = 0; slot < one.arrays.size(); ++slot) bound[slot] = &buffer(one.arrays[slot]);
        compute::Launch launch{.kernel = one.kernel,
                               .buffers = std::span(bound.data(), one.arrays.size()),
                               .parameters = parameters_.get(),
                               .phase = spec.phase,
                               .count = spec.count};
        if (spec.launchRow) {
            launch.arguments = &buffer(Array::DispatchArgs);
            launch.argumentsOffset = *spec.launchRow * sizeof(glm::uvec4);
        }
        device_.launch(launch);
    }
    if (timed) device_.endTimer();
}

}  // namespace spherule::sim

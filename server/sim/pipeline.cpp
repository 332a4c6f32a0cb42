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

constexpr std::uint32_t workgroup = LAUNCH_THREADS;
constexpr std::uint32_t maxGroupsPerAxis = 32768;
static_assert(scene::maxSpheres <= Pipeline::idMask);
static_assert(scene::maxMaterials <= 1U << (32 - Pipeline::idBits));

// Returns groups x, y, z for a row of the launch table, as the kernels index them, and `count`.
glm::uvec4 argumentsOf(std::uint32_t row, std::uint32_t count) {
    constexpr std::array ofGroups{LAUNCH_GROUPS,    LAUNCH_BUNDLES,     LAUNCH_COLOUR,      LAUNCH_LEVEL,
                                  LAUNCH_CELL_RUNS, LAUNCH_MOVER_LEVEL, LAUNCH_MOVER_CELLS, LAUNCH_FORGET,
                                  LAUNCH_MOVERS,    LAUNCH_LOST_COLOUR};
    const bool countsGroups = std::ranges::find(ofGroups, row) != ofGroups.end();
    const std::uint32_t groups = countsGroups ? count : (count + workgroup - 1) / workgroup;
    const std::uint32_t x = std::min(groups, maxGroupsPerAxis);
    return {x, x == 0 ? 1 : (groups + x - 1) / x, 1, count};
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
    forEachColumn([&](auto column, Array /*array*/) { (state.*column).resize(spheres); });
    if (!slots.images.empty()) state.images.resize(spheres);
    for (std::size_t slot = 0; slot < spheres; ++slot) {
        const std::uint32_t handle = slots.idAndMaterial[slot] & Pipeline::idMask;
        const std::uint32_t rank = ranks.empty() ? handle : ranks[handle];
        forEachColumn([&](auto column, Array /*array*/) {
            if (!(slots.*column).empty()) (state.*column)[rank] = (slots.*column)[slot];
        });
        state.spin[rank].w = 0;
        if (!slots.images.empty()) {
            state.images[rank] = glm::ivec3(slots.images[handle]);
            wrap(state.position[rank], state.images[rank], slots.periods);
        }
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

Pipeline::Pipeline(compute::Device& device, Plan plan, MadeKernels made)
    : device_(device), plan_(std::move(plan)), kernelFiles_(std::move(made.files)), kernels_(std::move(made.kernels)) {
    if (plan_.features.has(Feature::Contacts)) rebuildWords_ = device_.createWordQueue();
    for (const auto* launches : {&plan_.substep, &plan_.newSubstep, &plan_.statistics, &plan_.stepEnd})
        for (const LaunchSpec& launch : *launches)
            if (std::ranges::find(kernelFiles_, launch.kernel) == kernelFiles_.end())
                kernelFiles_.push_back(launch.kernel);
}

MadeKernels Pipeline::takeKernels() {
    kernelFiles_.resize(kernels_.size());
    return {.files = std::move(kernelFiles_), .kernels = std::move(kernels_)};
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
    for (const std::uint32_t count : plan_.dispatchSizes)
        rows.push_back(argumentsOf(static_cast<std::uint32_t>(rows.size()) % LAUNCH_ROWS, count));
    write<glm::uvec4>(Array::DispatchSizes, rows);
}

Result<void> Pipeline::makeKernel(std::string_view file) {
    auto kernel = device_.createKernel(shaders(), file, definesFor(plan_.features));
    // The device is at fault, not the user's scene.
    if (!kernel) return fail(ErrorKind::NoDevice, kernel.error().where, kernel.error().message);
    kernels_.push_back(std::move(*kernel));
    return {};
}

Result<Pipeline::BoundLaunch> Pipeline::bind(const LaunchSpec& spec) {
    const auto index = std::ranges::find(kernelFiles_, spec.kernel) - kernelFiles_.begin();
    const compute::Kernel& kernel = *kernels_[static_cast<std::size_t>(index)];
    auto arrays = arraysFor(spec, kernel);
    if (!arrays) return tl::unexpected(arrays.error());
    return BoundLaunch{.spec = &spec, .kernel = &kernel, .arrays = std::move(*arrays)};
}

Result<void> Pipeline::bindAll() {
    for (const auto& [launches, bound] : {std::pair(&plan_.substep, &substep_),
                                          {&plan_.newSubstep, &newSubstep_},
                                          {&plan_.statistics, &statistics_},
                                          {&plan_.stepEnd, &stepEnd_}})
        for (const LaunchSpec& spec : *launches) {
            auto one = bind(spec);
            if (!one) return tl::unexpected(one.error());
            bound->push_back(std::move(*one));
        }
    return {};
}

void Pipeline::setParameters(layout::Parameters parameters) {
    const float before = std::exchange(substepLength_, parameters.substep);
    parameters.substepRatio = before > 0 ? parameters.substep / before : 1;
    device_.upload(*parameters_, 0, std::as_bytes(std::span(&parameters, 1)));
    if (parameters.substepRatio == 1) return;
    run(newSubstep_, LaunchSet::Substep);
    awaitSpeeds();
}

// Writes the columns to the slots from `first` on.
void Pipeline::writeColumns(const State& state, std::size_t first) {
    forEachColumn([&]<class T>(std::vector<T> SphereColumns::*column, Array array) {
        if (plan_.has(array)) write<T>(array, state.*column, first);
    });
}

void Pipeline::upload(const State& state, std::span<const std::uint8_t> materials,
                      std::span<const std::uint32_t> handles) {
    setSpheres(state.count());
    // Clears all other data of the spheres that were in these slots.
    for (const ArraySpec& spec : plan_.arrays)
        if (typeOf(spec.array).cleared) device_.fill(buffer(spec.array), 0);
    writeColumns(state);
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
    counters[COUNTER_REBUILD] = REBUILD_DUE | REBUILD_ALL;
    write<std::uint32_t>(Array::Counters, counters);
    placeFarSlot();
    expectRebuild();
}

// Moves the slot that is no sphere away from all spheres.
void Pipeline::placeFarSlot() {
    if (!plan_.grid.hasMovers) return;
    constexpr float far = 1e18F;  // its square is finite
    const glm::vec4 place(far, far, far, 0);
    write<glm::vec4>(Array::Position, std::span<const glm::vec4>(&place, 1), plan_.room);
}

SlotState Pipeline::download() {
    return slotState(plan_.spheres, [](Array array) { return array; });
}

SlotState Pipeline::keptState(std::uint32_t spheres) {
    return slotState(spheres, keptOf);
}

// `of`: the array to read in the place of each array of the state.
SlotState Pipeline::slotState(std::uint32_t spheres, Array (*of)(Array)) {
    SlotState slots;
    forEachColumn([&](auto column, Array array) { readInto(slots.*column, of(array), spheres); });
    readInto(slots.idAndMaterial, of(Array::IdAndMaterial), spheres);
    readInto(slots.images, of(Array::Images));
    slots.periods = plan_.periods;
    return slots;
}

void Pipeline::keepState() {
    for (const auto& [array, kept] : keptArrays)
        if (plan_.has(array)) device_.copy(buffer(array), 0, plan_.bytesOf(array), buffer(kept), 0);
}

void Pipeline::wakeAll() {
    if (!plan_.features.has(Feature::Sleep)) return;
    auto velocity = read<glm::vec4>(Array::Velocity);
    for (glm::vec4& one : velocity) one.w = std::abs(one.w);
    write<glm::vec4>(Array::Velocity, velocity);
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
            device_.copy(buffer(spec.array), k * half, half, **made, k * (*made)->bytes() / halves);
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

void Pipeline::setSpheres(std::uint32_t count) {
    plan_.setSpheres(count);
    if (plan_.has(Array::DispatchSizes)) writeDispatchSizes();
}

void Pipeline::requestRebuild() {
    const std::uint32_t rebuild = REBUILD_DUE | REBUILD_ALL;
    write<std::uint32_t>(Array::Counters, std::span<const std::uint32_t>(&rebuild, 1), COUNTER_REBUILD);
    expectRebuild();
}

void Pipeline::expectRebuild() {
    listsPending_ = true;
    listsRead_ = false;
    // The next substep foretells otherwise if lists are built before it to read the state, so it does not count.
    unforeseen_ = substepsAhead + 1;
}

std::vector<glm::vec4> Pipeline::takeImpacts() {
    if (!impactsPending_ || !plan_.has(Array::Impacts)) return {};
    auto taken = read<glm::vec4>(Array::Impacts);
    device_.fill(buffer(Array::Impacts), 0);
    impactsPending_ = false;
    return taken;
}

void Pipeline::runStatistics() {
    buildListsToRead();
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

}  // namespace spherule::sim

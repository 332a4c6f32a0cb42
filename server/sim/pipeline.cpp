#include "sim/pipeline.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <fmt/format.h>

#include "core/memory.h"
#include "scene/load.h"
#include "scene/materials.h"
#include "sim/shaders.h"

namespace spherule::sim {

namespace {

constexpr std::uint32_t workgroup = 64;
constexpr std::uint32_t mostGroupsPerAxis = 32768;
constexpr std::uint32_t idBits = 24;  // of a label
constexpr std::uint32_t idMask = (1U << idBits) - 1;
static_assert(scene::maxSpheres <= idMask);
static_assert(scene::maxMaterials <= 1U << (32 - idBits));

// Groups x, y, z for `invocations`, as the kernels index them.
glm::uvec4 groupsFor(std::uint32_t invocations) {
    const std::uint32_t groups = (invocations + workgroup - 1) / workgroup;
    const std::uint32_t x = std::min(groups, mostGroupsPerAxis);
    return {x, x == 0 ? 1 : (groups + x - 1) / x, 1, invocations};
}

// What was refused is one array: whoever has to make room needs to know of them all.
Error withNeed(Error error, const Plan& plan) {
    if (error.kind == ErrorKind::Refused)
        error.message +=
            fmt::format(" (the scene needs {:.1f} MiB in all)", static_cast<double>(plan.bytes()) / (1 << 20));
    return error;
}

// Arrays whose size goes with the number of listed pairs.
bool holdsPairs(Array array) {
    return array == Array::Pairs || array == Array::History || array == Array::Kept;
}

}  // namespace

State inIdOrder(const SlotState& slots) {
    const std::size_t spheres = slots.label.size();
    const bool spins = slots.velocity.size() > spheres;
    State state;
    state.position.resize(spheres);
    state.velocity.resize(spheres);
    state.spin.resize(spheres);
    for (std::size_t slot = 0; slot < spheres; ++slot) {
        const std::uint32_t id = slots.label[slot] & idMask;
        state.position[id] = slots.position[slot];
        state.velocity[id] = slots.velocity[slot];
        if (spins) state.spin[id] = glm::vec4(glm::vec3(slots.velocity[spheres + slot]), 0);
    }
    return state;
}

Pipeline::Pipeline(compute::Device& device, Plan plan) : device_(device), plan_(std::move(plan)) {
    for (const auto* launches : {&plan_.substep, &plan_.statistics})
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
    else
        return false;
    if (!done) return tl::unexpected(done.error());
    return true;
}

double Pipeline::shareMade() const {
    const std::size_t all = plan_.arrays.size() + kernelFiles_.size();
    return all > 0 ? static_cast<double>(arraysMade_ + kernels_.size()) / static_cast<double>(all) : 1;
}

void Pipeline::adopt(Array array, std::unique_ptr<compute::Buffer> made) {
    const auto index = static_cast<std::size_t>(array);
    owned_[index] = std::move(made);
    slots_[index] = owned_[index].get();
}

Result<void> Pipeline::makeSmallArrays() {
    auto parameters = device_.createBuffer("parameters", sizeof(layout::Parameters), layout::parameterWords);
    if (!parameters) return tl::unexpected(parameters.error());
    auto absent = device_.createBuffer("absent", 64);
    if (!absent) return tl::unexpected(absent.error());
    parameters_ = std::move(*parameters);
    absent_ = std::move(*absent);
    slots_.fill(absent_.get());
    return {};
}

Result<void> Pipeline::makeArray(const ArraySpec& spec) {
    auto made = device_.createBuffer(nameOf(spec.array), spec.bytes, wordsOf(spec.array));
    if (!made) return tl::unexpected(withNeed(made.error(), plan_));
    adopt(spec.array, std::move(*made));
    ++arraysMade_;
    if (spec.array == Array::FullLaunches) fillLaunches();
    return {};
}

void Pipeline::fillLaunches() {
    std::vector<glm::uvec4> rows;
    for (const std::uint32_t invocations : plan_.fullLaunches) rows.push_back(groupsFor(invocations));
    write<glm::uvec4>(Array::FullLaunches, rows);
}

Result<void> Pipeline::makeKernel(std::string_view file) {
    auto kernel = device_.createKernel(shaders(), file, definesFor(plan_.features));
    // Not the user's scene but the device is at fault.
    if (!kernel) return fail(ErrorKind::NoDevice, kernel.error().where, kernel.error().message);
    kernels_.emplace_back(file, std::move(*kernel));
    return {};
}

void Pipeline::setParameters(const layout::Parameters& parameters) {
    device_.upload(*parameters_, 0, std::as_bytes(std::span(&parameters, 1)));
}

void Pipeline::upload(const State& state, std::span<const std::uint8_t> materials) {
    // Whatever else there is of the spheres that were in these slots goes.
    for (const Array array : {Array::Position, Array::Velocity, Array::Before, Array::Woken, Array::Span, Array::Anchor,
                              Array::Stirred, Array::History, Array::WallHistory, Array::Work, Array::Impacts})
        if (plan_.has(array)) device_.fill(buffer(array), 0);
    write<glm::vec4>(Array::Position, state.position);
    write<glm::vec4>(Array::Velocity, state.velocity);
    if (plan_.features.friction) write<glm::vec4>(Array::Velocity, state.spin, state.count());
    std::vector<std::uint32_t> ids(state.count());
    std::iota(ids.begin(), ids.end(), 0U);
    if (plan_.has(Array::SlotOf)) write<std::uint32_t>(Array::SlotOf, ids);
    for (std::uint32_t id = 0; id < state.count(); ++id) ids[id] |= std::uint32_t{materials[id]} << idBits;
    write<std::uint32_t>(Array::Label, ids);
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
    readInto(slots.velocity, Array::Velocity, (plan_.features.friction ? 2 : 1) * std::size_t{plan_.spheres});
    readInto(slots.label, Array::Label, plan_.spheres);
}

std::uint32_t Pipeline::slotOf(std::uint32_t id) {
    std::uint32_t slot = id;
    if (plan_.has(Array::SlotOf))
        device_.download(buffer(Array::SlotOf), id * sizeof slot, std::as_writable_bytes(std::span(&slot, 1)));
    return slot;
}

glm::vec4 Pipeline::velocityOf(std::uint32_t id) {
    glm::vec4 velocity;
    device_.download(buffer(Array::Velocity), slotOf(id) * sizeof velocity,
                     std::as_writable_bytes(std::span(&velocity, 1)));
    return velocity;
}

void Pipeline::kick(std::uint32_t id, glm::vec3 impulse) {
    const std::uint32_t slot = slotOf(id);
    glm::vec4 velocity = velocityOf(id);
    velocity.w = std::abs(velocity.w);
    velocity += glm::vec4(impulse * velocity.w, 0);
    write<glm::vec4>(Array::Velocity, std::span<const glm::vec4>(&velocity, 1), slot);
    if (!plan_.features.sleep) return;
    // A slow push must reach the sleepers that it touches, too.
    constexpr glm::vec4 crept(0, 0, 0, CREPT);
    write<glm::vec4>(Array::Before, std::span<const glm::vec4>(&crept, 1), slot);
}

void Pipeline::wakeAll() {
    if (!plan_.features.sleep) return;
    auto velocity = read<glm::vec4>(Array::Velocity);
    velocity.resize(plan_.spheres);
    for (glm::vec4& one : velocity) one.w = std::abs(one.w);
    write<glm::vec4>(Array::Velocity, velocity);
}

// By parts: a copy of the whole would take as much memory again.
void Pipeline::copy(compute::Buffer& from, compute::Buffer& to) {
    constexpr std::size_t most = 16U << 20U;
    std::vector<std::byte> part;
    for (std::size_t first = 0; first < from.bytes(); first += part.size()) {
        part.resize(std::min(most, from.bytes() - first));
        device_.download(from, first, part);
        device_.upload(to, first, part);
    }
}

Result<void> Pipeline::growPairs(std::uint32_t capacity) {
    const auto grownBytes = [&](const ArraySpec& spec) { return spec.bytes / plan_.pairCapacity * capacity; };
    std::uint64_t onHost = 0;
    for (const ArraySpec& spec : plan_.arrays)
        if (holdsPairs(spec.array)) onHost += device_.hostBytes(grownBytes(spec), wordsOf(spec.array));
    const auto claim = memory::Claim::make("", fmt::format("lists of {} pairs", capacity), onHost);
    if (!claim) return tl::unexpected(claim.error());
    std::vector<std::unique_ptr<compute::Buffer>> grown;
    for (ArraySpec& spec : plan_.arrays) {
        if (!holdsPairs(spec.array)) continue;
        auto made = device_.createBuffer(nameOf(spec.array), grownBytes(spec), wordsOf(spec.array));
        if (!made) return tl::unexpected(made.error());
        // The old lists are read once more as the new ones are made.
        copy(buffer(spec.array), **made);
        grown.push_back(std::move(*made));
    }
    auto next = grown.begin();
    for (ArraySpec& spec : plan_.arrays) {
        if (!holdsPairs(spec.array)) continue;
        spec.bytes = (*next)->bytes();
        adopt(spec.array, std::move(*next++));
    }
    plan_.pairCapacity = capacity;
    const std::uint32_t rebuild = 1;
    write<std::uint32_t>(Array::Counters, std::span<const std::uint32_t>(&rebuild, 1), COUNTER_REBUILD);
    listsPending_ = true;
    return {};
}

void Pipeline::substep(bool observed) {
    run(plan_.substep, observed);
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
        std::vector<LaunchSpec> rebuild;
        std::ranges::copy_if(plan_.substep, std::back_inserter(rebuild), [](const LaunchSpec& launch) {
            return launch.pass == Pass::Grid || launch.pass == Pass::Lists || launch.pass == Pass::History;
        });
        // Who only looks takes no turn: a crowd's next lists depend on how many there have been.
        const auto before = read<std::uint32_t>(Array::Counters);
        run(rebuild);
        for (const std::uint32_t word : {COUNTER_REBUILDS, COUNTER_SUBSTEPS})
            write<std::uint32_t>(Array::Counters, std::span<const std::uint32_t>(&before[word], 1), word);
        listsPending_ = false;
    }
    run(plan_.statistics);
}

void Pipeline::run(const std::vector<LaunchSpec>& launches, bool observed) {
    std::optional<Pass> timed;
    std::array<compute::Buffer*, 8> bound{};
    for (const LaunchSpec& spec : launches) {
        if (spec.observing && !observed) continue;
        if (timed != spec.pass) {
            if (timed) device_.endTimer();
            device_.beginTimer(static_cast<unsigned>(spec.pass));
            timed = spec.pass;
        }
        for (std::size_t slot = 0; slot < spec.slots.size(); ++slot) bound[slot] = &buffer(spec.slots[slot]);
        const auto kernel =
            std::ranges::find_if(kernels_, [&](const auto& known) { return known.first == spec.kernel; });
        compute::Launch launch{.kernel = kernel->second.get(),
                               .buffers = std::span(bound.data(), spec.slots.size()),
                               .parameters = parameters_.get(),
                               .phase = spec.phase,
                               .count = spec.count};
        if (spec.launchRow) {
            launch.arguments = &buffer(Array::Launches);
            launch.argumentsOffset = *spec.launchRow * sizeof(glm::uvec4);
        }
        device_.launch(launch);
    }
    if (timed) device_.endTimer();
}

}  // namespace spherule::sim

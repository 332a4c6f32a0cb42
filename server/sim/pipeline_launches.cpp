#include <algorithm>
#include <array>
#include <utility>

#include "sim/pipeline.h"

// The launches of a substep.
namespace spherule::sim {

// The next lists depend on these counters, which must count only the lists of substeps.
void Pipeline::rebuildLists() {
    const auto before = read<std::uint32_t>(Array::Counters);
    launchesRebuild_ = listsMayBeMissing_ = moversMayExist_ = true;
    run(substep_, LaunchSet::Rebuild);
    for (const std::uint32_t word : {COUNTER_REBUILDS, COUNTER_SUBSTEPS, COUNTER_LEAVING, COUNTER_AWAKE_MOVERS})
        write<std::uint32_t>(Array::Counters, std::span<const std::uint32_t>(&before[word], 1), word);
    listsPending_ = false;
}

Pipeline::LaunchState Pipeline::launchState() {
    LaunchState state{.listsPending = listsPending_,
                      .impactsPending = impactsPending_,
                      .launchesRebuild = launchesRebuild_,
                      .listsMayBeMissing = listsMayBeMissing_,
                      .moversMayExist = moversMayExist_,
                      .substepLength = substepLength_,
                      .unforeseen = unforeseen_,
                      .unlistedBirths = unlistedBirths_};
    while (rebuildWords_ && rebuildWords_->underWay() > 0) state.rebuildWords.push_back(rebuildWords_->take());
    startWords(state.rebuildWords);
    return state;
}

void Pipeline::restore(const LaunchState& state) {
    listsPending_ = state.listsPending;
    listsRead_ = false;
    impactsPending_ = state.impactsPending;
    launchesRebuild_ = state.launchesRebuild;
    listsMayBeMissing_ = state.listsMayBeMissing;
    moversMayExist_ = state.moversMayExist;
    substepLength_ = state.substepLength;
    unforeseen_ = state.unforeseen;
    unlistedBirths_ = state.unlistedBirths;
    while (rebuildWords_ && rebuildWords_->underWay() > 0) static_cast<void>(rebuildWords_->take());
    startWords(state.rebuildWords);
}

// Lets rebuildWords_ return these words.
void Pipeline::startWords(std::span<const std::uint32_t> words) {
    if (!rebuildWords_ || words.empty()) return;
    // The words pass through a buffer whose content does not matter.
    words = words.first(std::min<std::size_t>(words.size(), compute::WordQueue::most));
    device_.upload(*absent_, 0, std::as_bytes(words));
    for (std::size_t k = 0; k < words.size(); ++k) rebuildWords_->start(*absent_, k * sizeof(std::uint32_t));
}

// Reading must not change the simulation. A substep builds lists after the spheres have got new velocities, and in
// `fast` and `accurate` new places. Lists that were built before would have another drift, or other pairs, so they are
// built again. Further readings of the state use the first lists: to build them overwrites the figures that frames
// share.
void Pipeline::buildListsToRead() {
    if (!listsPending_ || listsRead_ || !plan_.features.has(Feature::Contacts)) return;
    const std::uint32_t due = read<std::uint32_t>(Array::Counters, 1).front();
    rebuildLists();
    if ((due & REBUILD_ALL) == 0) return;
    write<std::uint32_t>(Array::Counters, std::span<const std::uint32_t>(&due, 1), COUNTER_REBUILD);
    listsPending_ = listsRead_ = true;
}

void Pipeline::substep(bool observed) {
    // Lists of new spheres alone are built before, whether something has read them or not.
    if (listsPending_ && unlistedBirths_ > 0 && (read<std::uint32_t>(Array::Counters, 1).front() & REBUILD_ALL) == 0)
        rebuildLists();
    if (pulling_) run(pulls_, LaunchSet::Substep);
    chooseLaunches();
    run(substep_, observed ? LaunchSet::ObservedSubstep : LaunchSet::Substep);
    if (rebuildWords_) rebuildWords_->start(buffer(Array::Counters), COUNTER_REBUILD * sizeof(std::uint32_t));
    listsPending_ = false;
    unlistedBirths_ = 0;
    impactsPending_ = impactsPending_ || observed;
}

// Decides by COUNTER_REBUILD at the end of the substep before the last one. So the host does not wait for the last one,
// and the decision is the same on all devices.
void Pipeline::chooseLaunches() {
    const bool rebuiltBefore = launchesRebuild_;
    std::uint32_t word = REBUILD_SOON | LISTS_MISSING;
    if (rebuildWords_ && rebuildWords_->underWay() > 1) word = rebuildWords_->take();
    if (unforeseen_ > 0) {
        --unforeseen_;
        word |= REBUILD_SOON;
    }
    launchesRebuild_ = (word & (REBUILD_DUE | REBUILD_SOON | REBUILD_WAS_SOON)) != 0;
    listsMayBeMissing_ = launchesRebuild_ || rebuiltBefore || (word & LISTS_MISSING) != 0;
    moversMayExist_ = launchesRebuild_ || rebuiltBefore || (word & MOVERS_EXIST) != 0;
}

std::uint32_t Pipeline::longestChain() {
    std::uint32_t chain = 0;
    const auto words = read<std::uint32_t>(Array::Bundles, std::size_t{plan_.grid.bundles()} * BUNDLE_WORDS);
    for (const Level& level : plan_.grid.levels)
        for (std::uint32_t colour = 0; colour < 8; ++colour) {
            std::uint32_t longest = 0;
            for (std::uint32_t k = 0; k < level.bundlesOfColour(); ++k) {
                const std::size_t bundle = level.firstBundle + colour * level.bundlesOfColour() + k;
                const auto row = std::span(words).subspan(bundle * BUNDLE_WORDS, BUNDLE_WORDS);
                if (row[1] == 0 || row[1] == UNLISTED) continue;
                const auto ends = row.subspan(4, BATCHES);  // of the batches
                std::uint32_t batches = row[4 + BATCHES] - ends.back();
                std::uint32_t begin = row[0];
                for (const std::uint32_t end : ends) batches += std::exchange(begin, end) != end ? 1 : 0;
                longest = std::max(longest, batches);
            }
            chain += longest;
        }
    return chain;
}

void Pipeline::run(const std::vector<BoundLaunch>& launches, LaunchSet set) {
    const auto isLaunched = [&](std::uint32_t row) {
        if (row == LAUNCH_UNLISTED) return listsMayBeMissing_;
        return row == LAUNCH_MOVERS ? moversMayExist_ : launchesRebuild_;
    };
    const auto skipped = [&](const LaunchSpec& spec) {
        if (spec.launchRow && !isLaunched(*spec.launchRow)) return true;
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
                               .phase = spec.decidesRebuild ? std::uint32_t{launchesRebuild_} : spec.phase,
                               .count = spec.count};
        if (spec.launchRow) {
            launch.arguments = &buffer(Array::DispatchArgs);
            launch.argumentsOffset = *spec.launchRow * sizeof(glm::uvec4);
        }
        device_.launch(launch);
        ++launches_;
    }
    if (timed) device_.endTimer();
}

}  // namespace spherule::sim

#include "sim/modules/module.h"

#include <algorithm>

#include "sim/sphere_columns.h"

namespace spherule::sim {

const std::array<const Module*, featureCount>& modules() {
    static const std::array<const Module*, featureCount> all = {
#define FEATURE(flag, Name, text) &module##Name,
#include "features.def"
#undef FEATURE
    };
    return all;
}

void PlanBuilder::arrays(std::initializer_list<Array> needed) {
    for (const Array array : needed)
        if (!plan_.has(array)) plan_.arrays.push_back({array, plan_.bytesFor(array, scene_)});
}

void PlanBuilder::overSpheres(Stage stage, Pass pass, std::string_view kernel, std::vector<Alias> aliases) {
    staged_.push_back(
        {stage, {.pass = pass, .kernel = kernel, .over = Varying::Spheres, .aliases = std::move(aliases)}});
}

void PlanBuilder::overBundles(Stage stage, Pass pass, std::string_view kernel) {
    staged_.push_back({stage, {.pass = pass, .kernel = kernel, .count = plan_.grid.bundles()}});
}

void PlanBuilder::overStatisticBlocks(Stage stage, Pass pass, std::string_view kernel) {
    staged_.push_back({stage, {.pass = pass, .kernel = kernel, .over = Varying::StatisticBlocks}});
}

void PlanBuilder::overPairs(Stage stage, Pass pass, std::string_view kernel) {
    if (!has(Feature::Contacts)) return;
    for (std::uint32_t level = 0; level < plan_.grid.levels.size(); ++level)
        for (std::uint32_t colour = 0; colour < 8; ++colour) {
            staged_.push_back({stage,
                               {.pass = pass,
                                .kernel = kernel,
                                .count = plan_.grid.levels[level].bundlesOfColour(),
                                .phase = 8 * level + colour}});
            if (level == plan_.grid.sizes()) staged_.back().launch.launchRow = LAUNCH_MOVERS;
        }
}

void PlanBuilder::overPairsIf(Stage stage, Pass pass, std::string_view kernel, std::uint32_t row, std::uint32_t bits) {
    const std::size_t first = staged_.size();
    overPairs(stage, pass, kernel);
    for (std::size_t k = first; k < staged_.size(); ++k) {
        staged_[k].launch.launchRow = row;
        staged_[k].launch.phase |= bits;
    }
}

void PlanBuilder::overLevelsOnRebuild(Stage stage, Pass pass, std::string_view kernel) {
    for (std::uint32_t level = 0; level < plan_.grid.levels.size(); ++level)
        onRebuild(stage, pass, kernel, level == plan_.grid.sizes() ? LAUNCH_MOVER_LEVEL : LAUNCH_LEVEL, {}, level);
}

void PlanBuilder::once(Stage stage, Pass pass, std::string_view kernel) {
    staged_.push_back({stage, {.pass = pass, .kernel = kernel, .count = 1}});
}

void PlanBuilder::decidesRebuild(Stage stage, Pass pass, std::string_view kernel) {
    once(stage, pass, kernel);
    staged_.back().launch.decidesRebuild = true;
}

void PlanBuilder::onRebuild(Stage stage, Pass pass, std::string_view kernel, std::uint32_t row,
                            std::vector<Alias> aliases, std::uint32_t phase) {
    staged_.push_back(
        {stage, {.pass = pass, .kernel = kernel, .launchRow = row, .phase = phase, .aliases = std::move(aliases)}});
}

void PlanBuilder::prefixSumOnRebuild(Stage stage, Pass pass, Array values, std::array<std::uint32_t, 2> rows,
                                     std::uint32_t count) {
    const auto scan = [&](std::string_view kernel, std::vector<Alias> of, std::uint32_t row, std::uint32_t phase) {
        onRebuild(stage, pass, kernel, row, std::move(of), phase);
    };
    const std::vector<Alias> low{{"values", values}, {"sums", Array::BlockSums}};
    const std::vector<Alias> high{{"values", Array::BlockSums}, {"sums", Array::SuperSums}};
    const std::uint32_t blocks = blocksOf(count, SCAN_BLOCK);
    const std::uint32_t superBlocks = blocksOf(blocks, SCAN_BLOCK);
    scan("scan_reduce.comp", low, rows[0], count);
    scan("scan_reduce.comp", high, rows[1], blocks);
    scan("scan_top.comp", {{"sums", Array::SuperSums}}, LAUNCH_ONE, superBlocks);
    scan("scan_spread.comp", high, rows[1], blocks);
    scan("scan_spread.comp", low, rows[0], count);
}

void PlanBuilder::observeSpheres(Stage stage, std::string_view kernel, std::vector<Alias> aliases) {
    overSpheres(stage, Pass::Statistics, kernel, std::move(aliases));
    staged_.back().launch.observing = true;
}

void PlanBuilder::observeBundles(Stage stage, std::string_view kernel, std::vector<Alias> aliases) {
    overBundles(stage, Pass::Statistics, kernel);
    staged_.back().launch.observing = true;
    staged_.back().launch.aliases = std::move(aliases);
}

void PlanBuilder::onNewSubstepOverPairs(std::string_view kernel) {
    plan_.newSubstep.push_back({.pass = Pass::ContactMemory, .kernel = kernel, .over = Varying::PairsTwice});
}

void PlanBuilder::onNewSubstepOverSpheres(std::string_view kernel) {
    plan_.newSubstep.push_back({.pass = Pass::ContactMemory, .kernel = kernel, .over = Varying::Spheres});
}

void PlanBuilder::statisticsOfBundles(std::string_view kernel, std::vector<Alias> aliases) {
    overBundles(Stage::Statistics, Pass::Statistics, kernel);
    staged_.back().launch.aliases = std::move(aliases);
}

void PlanBuilder::statisticsOfSpheres(std::string_view kernel, std::vector<Alias> aliases) {
    overStatisticBlocks(Stage::Statistics, Pass::Statistics, kernel);
    staged_.back().launch.aliases = std::move(aliases);
}

void PlanBuilder::atStepEnd(Pass pass, std::string_view kernel) {
    plan_.stepEnd.push_back({.pass = pass, .kernel = kernel, .over = Varying::Spheres});
}

void PlanBuilder::finish() {
    for (const auto& [array, kept] : keptArrays)
        if (plan_.has(array)) arrays({kept});
    std::ranges::sort(plan_.arrays, {}, &ArraySpec::array);
    if (has(Feature::Contacts))
        for (const ArraySpec& spec : plan_.arrays) {
            if (!typeOf(spec.array).sorted) continue;
            const bool words = typeOf(spec.array).type == "uint";
            const std::vector<Alias> column{{"column", spec.array}};
            onRebuild(Stage::SortColumns, Pass::Grid, words ? "sort_words.comp" : "sort_vectors.comp", LAUNCH_COLUMNS,
                      column);
            onRebuild(Stage::SortColumns, Pass::Grid, words ? "copy_words.comp" : "copy_vectors.comp", LAUNCH_COLUMNS,
                      column);
        }
    std::ranges::stable_sort(staged_, {}, &Staged::stage);
    for (Staged& staged : staged_) {
        staged.launch.waking = staged.stage == Stage::Activity;
        (staged.stage == Stage::Statistics ? plan_.statistics : plan_.substep).push_back(std::move(staged.launch));
    }
    staged_.clear();
    plan_.setSpheres(plan_.spheres);
}

}  // namespace spherule::sim

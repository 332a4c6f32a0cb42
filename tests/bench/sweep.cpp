#include "methods.h"

namespace spherule::bench {

namespace {

using sim::layout::uint;
constexpr std::uint32_t sweepKeys = 65536;
constexpr std::uint32_t keyBlocks = sweepKeys / SCAN_BLOCK;

}  // namespace

Result<std::unique_ptr<Baseline>> sweepAndPrune(const Setting& setting) {
    const std::uint32_t n = setting.parameters.spheres;
    auto method = std::make_unique<Baseline>(setting, Baseline::State::InPlace);
    method->define("SWEEP_KEYS", std::to_string(sweepKeys) + "u");
    compute::Buffer* const keys = method->array("starts of the keys", std::size_t{sweepKeys} * 4);
    compute::Buffer* const sums = method->array("block sums", std::size_t{keyBlocks} * 4);
    compute::Buffer* const place = method->array("places", std::size_t{n} * 4);
    method->stage("clear.comp", {keys}, sweepKeys, sweepKeys);
    method->stage("sweep_count.comp", {method->position(0), keys, place}, n);
    method->stage("scan_reduce.comp", {keys, sums}, keyBlocks, sweepKeys);
    method->stage("scan_top.comp", {sums}, 1, keyBlocks);
    method->stage("scan_spread.comp", {keys, sums}, keyBlocks, sweepKeys);
    method->stage("sweep_scatter.comp",
                  {method->position(0), method->velocity(0), keys, place, method->position(1), method->velocity(1)}, n);
    method->response("sweep_respond.comp", {});
    if (auto ready = method->ready(); !ready) return tl::unexpected(ready.error());
    return method;
}

}  // namespace spherule::bench

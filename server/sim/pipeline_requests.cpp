// Launches that only viewers ask for: their kernels and arrays are made when they are first needed.
#include <array>
#include <span>
#include <utility>

#include "sim/pipeline.h"

namespace spherule::sim {

Result<void> Pipeline::bindLate(const std::vector<LaunchSpec>& launches, std::vector<BoundLaunch>& bound) {
    if (!bound.empty()) return {};
    std::vector<BoundLaunch> made;
    for (const LaunchSpec& spec : launches) {
        if (std::ranges::find(kernelFiles_, spec.kernel) == kernelFiles_.end()) {
            if (auto done = makeKernel(spec.kernel); !done) return done;
            kernelFiles_.push_back(spec.kernel);
        }
        auto one = bind(spec);
        if (!one) return tl::unexpected(one.error());
        made.push_back(std::move(*one));
    }
    bound = std::move(made);
    return {};
}

Result<compute::Buffer*> Pipeline::figures() {
    for (const Array array : {touchingArray, deepestArray, figuresArray})
        if (auto made = makeMissing(array, plan_.room); !made) return tl::unexpected(made.error());
    if (auto ready = bindLate(plan_.figures, figures_); !ready) return tl::unexpected(ready.error());
    buildListsToRead();
    run(figures_, LaunchSet::Substep);
    return &buffer(figuresArray);
}

Result<std::vector<std::uint32_t>> Pipeline::inspect(std::uint32_t handle) {
    if (auto ready = bindLate(plan_.inspection, inspection_); !ready) return tl::unexpected(ready.error());
    // A sphere finds the obstacles near it in the lists.
    buildListsToRead();
    const std::uint32_t none = 0;
    write<std::uint32_t>(Array::Inspected, std::span(&none, 1));
    plan_.inspection.front().phase = slotOf(handle);
    run(inspection_, LaunchSet::Substep);
    auto words = read<std::uint32_t>(Array::Inspected, 1);
    words = read<std::uint32_t>(Array::Inspected, 1 + 2 * std::min(words.front(), INSPECTED_MOST));
    return words;
}

}  // namespace spherule::sim

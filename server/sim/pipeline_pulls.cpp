// The part of Pipeline that pulls spheres by springs.
#include <array>
#include <numeric>
#include <utility>

#include "sim/pipeline.h"

namespace spherule::sim {

// Makes the array and the kernel, unless they exist.
Result<void> Pipeline::makePulls() {
    if (!pulls_.empty()) return {};
    if (!plan_.has(Array::SlotOf)) {
        if (auto made = makeSlotOf(); !made) return made;
        std::vector<std::uint32_t> slots(plan_.room);
        std::iota(slots.begin(), slots.end(), 0U);
        write<std::uint32_t>(Array::SlotOf, slots);
    }
    if (!plan_.has(Array::Pulls)) {
        const ArraySpec spec{Array::Pulls, std::uint64_t{MOST_PULLS} * PULL_ROWS * sizeof(glm::vec4)};
        auto made = device_.createBuffer(nameOf(spec.array), spec.bytes, typeOf(spec.array).words);
        if (!made) return tl::unexpected(made.error());
        setBuffer(spec.array, std::move(*made));
        plan_.arrays.push_back(spec);
    }
    if (auto made = makeKernel(pullSpec_.kernel); !made) return made;
    kernelFiles_.push_back(pullSpec_.kernel);
    auto bound = bind(pullSpec_);
    if (!bound) return tl::unexpected(bound.error());
    pulls_.push_back(std::move(*bound));
    return {};
}

// `rows`: of the springs, as in layout.h.
Result<void> Pipeline::setPulls(std::span<const glm::vec4> rows) {
    pulling_ = false;
    if (rows.empty()) return {};
    if (auto made = makePulls(); !made) return made;
    std::array<glm::vec4, std::size_t{MOST_PULLS} * PULL_ROWS> all{};
    std::ranges::copy(rows, all.begin());
    write<glm::vec4>(Array::Pulls, all);
    pulling_ = true;
    awaitSpeeds();
    return {};
}

glm::vec4 Pipeline::positionOf(std::uint32_t handle) {
    glm::vec4 position;
    device_.download(buffer(Array::Position), slotOf(handle) * sizeof position,
                     std::as_writable_bytes(std::span(&position, 1)));
    return position;
}

}  // namespace spherule::sim

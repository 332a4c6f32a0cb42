#include "faulty.h"

#include <algorithm>
#include <string>

#include "sim/layout.h"

namespace spherule::instruments {
namespace {

using compute::cpu::Binding;

using RunFunction = void (*)(const Binding&, std::uint32_t, std::uint32_t);

// Returns inWorkGroups() with another function for one kernel.
std::span<const Entry> replaced(std::string_view file, RunFunction by) {
    static std::vector<Entry> table;
    table.assign(inWorkGroups().begin(), inWorkGroups().end());
    std::ranges::find(table, file, &Entry::name)->run = by;
    return table;
}

constexpr std::string_view listOrder = "list_order.comp";
constexpr std::string_view solve = "solve_contacts.comp";

// As in shaders/shared/bundle_words.h.
void joinBatches(const Binding& binding) {
    const Entry& kernel = kernelOf(inWorkGroups(), listOrder);
    const auto slot = std::ranges::find(kernel.buffers, "bundles", &compute::BufferDeclaration::name);
    auto* const words =
        static_cast<std::uint32_t*>(binding.slots[static_cast<std::size_t>(slot - kernel.buffers.begin())]);
    const auto& parameters = *static_cast<const sim::layout::Parameters*>(binding.parameters);
    for (std::uint32_t bundle = 0; bundle < parameters.bundles; ++bundle) {
        std::uint32_t* const row = words + std::size_t{bundle} * BUNDLE_WORDS;
        if (row[1] != UNLISTED && row[1] > 0) row[4] = row[5];
    }
}

}  // namespace

std::vector<std::uint32_t> launchControl(std::string_view kernel) {
    const Entry& found = kernelOf(controls(), kernel);
    std::vector<std::vector<std::uint32_t>> buffers(found.buffers.size(), std::vector<std::uint32_t>(256));
    std::vector<void*> slots;
    for (auto& buffer : buffers) slots.push_back(buffer.data());
    const Binding binding{.slots = slots};
    found.run(binding, 0, found.count(binding));
    return buffers.back();
}

std::span<const Entry> withoutCellOrder() {
    return replaced("cell_order.comp", [](const Binding&, std::uint32_t, std::uint32_t) {});
}

std::span<const Entry> withBatchesJoined() {
    return replaced(listOrder, [](const Binding& binding, std::uint32_t begin, std::uint32_t end) {
        kernelOf(inWorkGroups(), listOrder).run(binding, begin, end);
        joinBatches(binding);
    });
}

std::span<const Entry> withColoursJoined() {
    return replaced(solve, [](const Binding& binding, std::uint32_t begin, std::uint32_t end) {
        Binding next = binding;
        next.phase ^= 1U;
        kernelOf(inWorkGroups(), solve).run(binding, begin, end);
        kernelOf(inWorkGroups(), solve).run(next, begin, end);
    });
}

}  // namespace spherule::instruments

#include "kernels_support.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace spherule::kernels {

namespace {

uint blocksOf(std::size_t values) {
    return static_cast<uint>((values + SCAN_BLOCK - 1) / SCAN_BLOCK);
}

const compute::cpu::Entry& entryOf(std::string_view kernel, unsigned lanes) {
    std::vector<std::span<const compute::cpu::Entry>> tables;
    if (lanes == 4) tables.push_back(compute::cpu::kernelsWith4Lanes());
    if (lanes == 8) tables.push_back(compute::cpu::kernelsWith8Lanes());
    if (lanes == 16) tables.push_back(compute::cpu::kernelsWith16Lanes());
    tables.push_back(compute::cpu::floatKernels());
    for (const auto& table : tables) {
        const auto found = std::ranges::find(table, std::string(kernel) + ".comp", &compute::cpu::Entry::name);
        if (found != table.end()) return *found;
    }
    throw std::out_of_range(std::string(kernel));
}

}  // namespace

void launch(std::string_view kernel, std::span<const Slot> slots, const Launch& how) {
    const compute::cpu::Entry& found = entryOf(kernel, how.lanes);
    std::vector<void*> pointers;
    for (const auto& declared : found.buffers) {
        const auto slot = std::ranges::find(slots, declared.name, &Slot::name);
        if (slot == slots.end()) throw std::out_of_range(std::string(declared.name));
        pointers.push_back(slot->data);
    }
    const compute::cpu::Binding binding{
        .slots = pointers, .parameters = how.parameters, .phase = how.phase, .features = how.features};
    found.run(binding, 0, found.count(binding));
}

std::vector<std::string_view> kernelNames() {
    std::vector<std::string_view> names;
    for (const auto& entry : compute::cpu::floatKernels()) names.push_back(entry.name);
    return names;
}

void prefixSum(std::vector<uint>& values) {
    std::vector<uint> sums(blocksOf(values.size()));
    std::vector<uint> superSums(blocksOf(sums.size()));
    const auto count = [](const std::vector<uint>& v) { return Launch{.phase = static_cast<uint>(v.size())}; };
    launch("scan_reduce", {{"values", values}, {"sums", sums}}, count(values));
    launch("scan_reduce", {{"values", sums}, {"sums", superSums}}, count(sums));
    launch("scan_top", {{"sums", superSums}}, count(superSums));
    launch("scan_spread", {{"values", sums}, {"sums", superSums}}, count(sums));
    launch("scan_spread", {{"values", values}, {"sums", sums}}, count(values));
}

}  // namespace spherule::kernels

#include "sim/contact_sums.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace spherule::sim {

ContactSums ContactSums::since(const ContactSums& before) const {
    if (seconds < before.seconds) return *this;  // `before` is of another world
    ContactSums difference{.seconds = seconds - before.seconds,
                           .collisions = collisions - before.collisions,
                           .dissipated = dissipated - before.dissipated};
    for (std::size_t k = 0; k < virial.size(); ++k) difference.virial[k] = virial[k] - before.virial[k];
    return difference;
}

void addContactSums(ContactSums& sum, Pipeline& pipeline) {
    if (!pipeline.plan().features.has(Feature::ContactSums)) return;
    std::vector<float> work = pipeline.read<float>(Array::WorkOfContacts);
    for (float& part : work) sum.dissipated -= static_cast<double>(std::exchange(part, 0.0F));
    pipeline.write<float>(Array::WorkOfContacts, work);
    if (!pipeline.plan().has(Array::Bundles)) return;
    const std::size_t first = (std::size_t{pipeline.plan().grid.bundles()} + 1) * BUNDLE_WORDS;
    std::vector<std::uint32_t> words = pipeline.read<std::uint32_t>(Array::Bundles);
    const std::span<std::uint32_t> rows = std::span(words).subspan(first);
    for (std::size_t row = 0; row < rows.size(); row += SUM_WORDS) {
        const auto value = [&](std::size_t k) { return static_cast<double>(std::bit_cast<float>(rows[row + k])); };
        for (std::size_t k = 0; k < sum.virial.size(); ++k)
            if (std::isfinite(value(k))) sum.virial[k] += value(k);
        sum.collisions += value(sum.virial.size());
    }
    std::ranges::fill(rows, 0U);
    pipeline.write<std::uint32_t>(Array::Bundles, rows, first);
}

}  // namespace spherule::sim

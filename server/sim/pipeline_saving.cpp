// The part of Pipeline that saves its arrays and restores them.
#include <algorithm>

#include <fmt/format.h>

#include "sim/pipeline.h"

namespace spherule::sim {

namespace {

tl::unexpected<Error> unfit(Array array, const std::string& what) {
    return fail(ErrorKind::Input, "", fmt::format("the array {} {}", nameOf(array), what));
}

}  // namespace

std::vector<Pipeline::SavedArray> Pipeline::saveArrays() {
    std::vector<SavedArray> saved;
    for (const ArraySpec& spec : plan_.arrays) {
        if (typeOf(spec.array).scratch) continue;
        SavedArray& one = saved.emplace_back(SavedArray{.array = spec.array});
        one.bytes.resize(spec.bytes);
        device_.download(buffer(spec.array), 0, one.bytes);
    }
    return saved;
}

Result<void> Pipeline::restore(const std::vector<SavedArray>& arrays, const scene::Scene& scene) {
    for (const SavedArray& saved : arrays) {
        const std::uint64_t bytes = plan_.bytesFor(saved.array, scene);
        if (saved.bytes.size() != (plan_.has(saved.array) ? plan_.bytesOf(saved.array) : bytes))
            return unfit(saved.array, fmt::format("has {} bytes, must have {}", saved.bytes.size(), bytes));
        if (auto made = makeMissing(saved.array, bytes / typeOf(saved.array).elementBytes); !made) return made;
        device_.upload(buffer(saved.array), 0, saved.bytes);
    }
    for (const ArraySpec& spec : plan_.arrays)
        if (!typeOf(spec.array).scratch && std::ranges::find(arrays, spec.array, &SavedArray::array) == arrays.end())
            return unfit(spec.array, "is missing");
    return {};
}

}  // namespace spherule::sim

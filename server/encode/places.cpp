#include "encode/places.h"

#include <algorithm>
#include <numeric>

namespace spherule::encode {

namespace {

constexpr std::uint32_t block = 64;  // spheres that the codec encodes together

void addTo(std::vector<PlaceRun>& runs, std::uint32_t place, std::uint64_t id) {
    if (!runs.empty() && runs.back().first + runs.back().count == place && runs.back().id + runs.back().count == id)
        ++runs.back().count;
    else
        runs.push_back({place, 1, id});
}

}  // namespace

std::uint32_t Places::placesFor(std::uint32_t spheres) {
    constexpr std::uint32_t fewestFree = 64;
    constexpr std::uint32_t freeShare = 16;  // one place in so many
    const std::uint32_t wanted = spheres + std::max(fewestFree, spheres / freeShare);
    return (wanted + block - 1) / block * block;
}

Places::Places(const sim::Population& population) : lowestFree_(population.count()) {
    const std::uint32_t places = placesFor(population.count());
    order_.resize(places);
    std::iota(order_.begin(), order_.end(), 0U);
    idAt_.resize(places);
    for (std::uint32_t rank = 0; rank < population.count(); ++rank) {
        const std::uint64_t id = population.idAt(rank);
        idAt_[rank] = id;
        taken_.push_back({id, rank});
    }
}

void Places::setOrder(std::span<const std::uint32_t> ranks) {
    std::ranges::copy(ranks, order_.begin());  // free places come last
}

// Ids ascend, and new spheres have the largest ones: one pass over both lists finds the differences.
std::optional<Places::Change> Places::follow(const sim::Population& population) {
    Change change;
    std::uint32_t rank = 0;
    std::size_t kept = 0;
    for (const Taken& one : taken_) {
        if (rank < population.count() && population.idAt(rank) == one.id) {
            taken_[kept++] = one;
            ++rank;
            continue;
        }
        addTo(change.removed, one.place, one.id);
        idAt_[one.place].reset();
        lowestFree_ = std::min(lowestFree_, one.place);
    }
    taken_.resize(kept);
    for (; rank < population.count(); ++rank) {
        while (lowestFree_ < count() && idAt_[lowestFree_]) ++lowestFree_;
        if (lowestFree_ == count()) return std::nullopt;
        const std::uint64_t id = population.idAt(rank);
        addTo(change.added, lowestFree_, id);
        idAt_[lowestFree_] = id;
        taken_.push_back({id, lowestFree_});
    }
    return change;
}

std::vector<std::uint32_t> Places::handles(const sim::Population& population) const {
    constexpr std::uint32_t none = sim::Population::noRank;
    std::vector<std::uint32_t> handleAt(count(), none);
    for (std::uint32_t rank = 0; rank < taken_.size(); ++rank) handleAt[taken_[rank].place] = population.handleAt(rank);
    std::vector<std::uint32_t> handles(count());
    std::uint32_t last = population.handleAt(0);
    for (std::uint32_t begin = 0; begin < count(); begin += block) {
        const std::uint32_t end = std::min(begin + block, count());
        // The first sphere of the block stands in for the free places before it.
        for (std::uint32_t k = begin; k < end; ++k) {
            if (handleAt[order_[k]] == none) continue;
            last = handleAt[order_[k]];
            break;
        }
        for (std::uint32_t k = begin; k < end; ++k) {
            if (handleAt[order_[k]] != none) last = handleAt[order_[k]];
            handles[k] = last;
        }
    }
    return handles;
}

std::vector<PlaceRun> Places::inUse() const {
    std::vector<PlaceRun> runs;
    for (const Taken& one : taken_) addTo(runs, one.place, one.id);
    return runs;
}

}  // namespace spherule::encode

#include "sim/population.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace spherule::sim {

Population::Population(std::uint32_t spheres, std::uint64_t firstId)
    : firstId_(firstId), nextId_(firstId + spheres), count_(spheres), handles_(spheres) {}

std::uint64_t Population::idAt(std::uint32_t rank) const {
    return hasTables_ ? ids_[rank] : firstId_ + rank;
}

std::uint32_t Population::handleAt(std::uint32_t rank) const {
    return hasTables_ ? ofRank_[rank] : rank;
}

std::optional<std::uint32_t> Population::rankOf(std::uint64_t id) const {
    if (!hasTables_) {
        if (id < firstId_ || id - firstId_ >= count_) return std::nullopt;
        return static_cast<std::uint32_t>(id - firstId_);
    }
    const auto found = std::ranges::lower_bound(ids_, id);
    if (found == ids_.end() || *found != id) return std::nullopt;
    return static_cast<std::uint32_t>(found - ids_.begin());
}

std::uint32_t Population::rankOfHandle(std::uint32_t handle) const {
    return hasTables_ ? rankOf(idsOf_[handle]).value_or(noRank) : handle;
}

std::vector<std::uint32_t> Population::ranksByHandle() const {
    if (!hasTables_) return {};
    std::vector<std::uint32_t> ranks(handles_, noRank);
    for (std::uint32_t rank = 0; rank < count_; ++rank) ranks[ofRank_[rank]] = rank;
    return ranks;
}

bool Population::isWhole() const {
    if (nextId_ < firstId_ || born() < count_ || handles_ < count_) return false;
    if (!hasTables_) return handles_ == count_ && born() == count_ && ids_.empty() && ofRank_.empty();
    if (ids_.size() != count_ || ofRank_.size() != count_ || idsOf_.size() != handles_) return false;
    std::vector<bool> used(handles_);
    for (std::uint32_t rank = 0; rank < count_; ++rank) {
        const bool ascends = rank == 0 || ids_[rank] > ids_[rank - 1];
        const std::uint32_t handle = ofRank_[rank];
        if (!ascends || ids_[rank] >= nextId_ || handle >= handles_ || used[handle]) return false;
        if (idsOf_[handle] != ids_[rank]) return false;
        used[handle] = true;
    }
    const auto takes = [&](std::uint32_t handle) {
        const bool fits = handle < handles_ && !used[handle];
        if (fits) used[handle] = true;
        return fits;
    };
    for (auto left = free_; !left.empty(); left.pop())
        if (!takes(left.top())) return false;
    return std::ranges::all_of(resting_, takes, &Freed::handle);
}

void Population::makeTables() {
    if (hasTables_) return;
    hasTables_ = true;
    ids_.resize(count_);
    ofRank_.resize(count_);
    std::iota(ids_.begin(), ids_.end(), firstId_);
    std::iota(ofRank_.begin(), ofRank_.end(), 0U);
    idsOf_ = ids_;
}

std::vector<std::uint32_t> Population::add(std::uint32_t spheres, std::uint64_t step) {
    for (; !resting_.empty() && resting_.front().step + restSteps <= step; resting_.pop_front())
        free_.push(resting_.front().handle);
    std::vector<std::uint32_t> handles(spheres);
    for (std::uint32_t& handle : handles) {
        if (free_.empty()) {
            handle = handles_++;
        } else {
            handle = free_.top();
            free_.pop();
        }
    }
    if (hasTables_) {
        idsOf_.resize(handles_);
        for (const std::uint32_t handle : handles) {
            idsOf_[handle] = nextId_ + (ids_.size() - count_);
            ids_.push_back(idsOf_[handle]);
            ofRank_.push_back(handle);
        }
    }
    count_ += spheres;
    nextId_ += spheres;
    ++version_;
    return handles;
}

void Population::remove(std::span<const std::uint32_t> ranks, std::uint64_t step) {
    if (ranks.empty()) return;
    makeTables();
    std::vector<std::uint32_t> freed;
    auto next = ranks.begin();
    std::uint32_t kept = 0;
    for (std::uint32_t rank = 0; rank < count_; ++rank) {
        if (next != ranks.end() && *next == rank) {
            freed.push_back(ofRank_[rank]);
            ++next;
            continue;
        }
        ids_[kept] = ids_[rank];
        ofRank_[kept] = ofRank_[rank];
        ++kept;
    }
    assert(next == ranks.end());
    ids_.resize(kept);
    ofRank_.resize(kept);
    count_ = kept;
    std::ranges::sort(freed);
    for (const std::uint32_t handle : freed) resting_.push_back({step, handle});
    ++version_;
}

void Population::skipTo(std::uint64_t id) {
    if (id <= nextId_) return;
    makeTables();
    nextId_ = id;
    ++version_;
}

void Population::renumber() {
    handles_ = count_;
    std::iota(ofRank_.begin(), ofRank_.end(), 0U);
    idsOf_ = ids_;
    resting_.clear();
    free_ = {};
}

}  // namespace spherule::sim

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

namespace spherule::sim {

// Which spheres a simulation has. Each sphere has
// - an id: births are counted, and an id is never used again;
// - a rank: its place among the present spheres in the order of their ids. States on the host are in this order;
// - a handle: the number by which arrays on the device know it ("by id" in sim/arrays.def). Handles are used again.
// As long as no sphere has been removed, handle and rank are equal, ids count on from the first one, and no tables are
// kept.
class Population {
  public:
    // `spheres` are born, with the ids from `firstId` on.
    explicit Population(std::uint32_t spheres = 0, std::uint64_t firstId = 0);

    [[nodiscard]] std::uint32_t count() const { return count_; }
    [[nodiscard]] std::uint64_t born() const { return nextId_ - firstId_; }
    [[nodiscard]] std::uint64_t removed() const { return born() - count_; }
    // One more than the largest handle that was ever used.
    [[nodiscard]] std::uint32_t handles() const { return handles_; }
    [[nodiscard]] std::uint64_t nextId() const { return nextId_; }
    // Grows with each change.
    [[nodiscard]] std::uint64_t version() const { return version_; }

    // True if id, rank and handle of each sphere are equal.
    [[nodiscard]] bool plain() const { return !hasTables_ && firstId_ == 0; }
    [[nodiscard]] std::uint64_t idAt(std::uint32_t rank) const;
    [[nodiscard]] std::uint32_t handleAt(std::uint32_t rank) const;
    [[nodiscard]] std::optional<std::uint32_t> rankOf(std::uint64_t id) const;
    [[nodiscard]] bool wasBorn(std::uint64_t id) const { return id >= firstId_ && id < nextId_; }
    [[nodiscard]] std::uint32_t rankOfHandle(std::uint32_t handle) const;  // of a present sphere
    // Returns the ranks by handle; noRank for free handles. Empty if the population is plain.
    [[nodiscard]] std::vector<std::uint32_t> ranksByHandle() const;

    // Adds spheres, with the next ids and the lowest free handles. Returns the handles, in the order of the ids.
    // `step`: the present step. Handles that were freed less than `restSteps` steps ago are not used.
    std::vector<std::uint32_t> add(std::uint32_t spheres, std::uint64_t step);
    // Removes the spheres with these ranks, in ascending order, and frees their handles.
    void remove(std::span<const std::uint32_t> ranks, std::uint64_t step);
    // The next spheres get ids from `id` on. The ids left out count as born and removed.
    void skipTo(std::uint64_t id);
    // Makes handles equal to ranks again: all arrays by handle are new. Ids stay.
    void renumber();

    template <class Archive>
    void archive(Archive& a) {
        std::vector<std::uint32_t> free;
        if constexpr (!Archive::loads)
            for (auto left = free_; !left.empty(); left.pop()) free.push_back(left.top());
        a(firstId_, nextId_, version_, count_, handles_, hasTables_, ids_, ofRank_, idsOf_, resting_, free);
        if constexpr (Archive::loads) free_ = decltype(free_)(std::greater<>(), std::move(free));
    }
    // Returns true if its tables fit each other. Others come only from damaged archives.
    [[nodiscard]] bool isWhole() const;

    static constexpr std::uint64_t restSteps = 2;
    static constexpr std::uint32_t noRank = 0xffffffff;
    // Memory of the tables for each sphere (bytes).
    static constexpr std::size_t bytesPerSphere = sizeof(std::uint64_t) * 2 + sizeof(std::uint32_t);

  private:
    void makeTables();

    struct Freed {
        std::uint64_t step = 0;
        std::uint32_t handle = 0;

        template <class Archive>
        void archive(Archive& a) {
            a(step, handle);
        }
    };

    std::uint64_t firstId_ = 0;
    std::uint64_t nextId_ = 0;
    std::uint64_t version_ = 0;
    std::uint32_t count_ = 0;
    std::uint32_t handles_ = 0;
    bool hasTables_ = false;             // without tables, handles are ranks and ids are firstId_ + rank
    std::vector<std::uint64_t> ids_;     // by rank, ascending
    std::vector<std::uint32_t> ofRank_;  // handles by rank
    std::vector<std::uint64_t> idsOf_;   // by handle
    std::deque<Freed> resting_;          // in the order of the steps
    std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> free_;
};

}  // namespace spherule::sim

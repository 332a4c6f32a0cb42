#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/population.h"

namespace spherule::encode {

// Spheres with consecutive ids at consecutive places.
struct PlaceRun {
    std::uint32_t first = 0;  // place
    std::uint32_t count = 0;
    std::uint64_t id = 0;  // of the sphere at the first place
};

// The places of spheres in the frames of clients that follow Population messages. There are more places than spheres,
// so that new spheres find one, and the order of the places never changes. Frames hold for a free place the values of
// another sphere, preferably a neighbour in the codec's order: so it costs few bytes.
class Places {
  public:
    // Each sphere gets the place of its rank.
    explicit Places(const sim::Population& population);

    // Sets the codec's order. `ranks`: of all spheres, neighbours near each other. Only before follow().
    void setOrder(std::span<const std::uint32_t> ranks);

    struct Change {
        std::vector<PlaceRun> removed;
        std::vector<PlaceRun> added;
    };
    // Follows a change of the population. Returns nullopt, and must be replaced, if there are too few places.
    std::optional<Change> follow(const sim::Population& population);

    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(idAt_.size()); }
    // The places in the codec's order, as Order holds them.
    [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }
    // Returns the handle of the sphere whose values frames hold, in the codec's order. Not for an empty population.
    [[nodiscard]] std::vector<std::uint32_t> handles(const sim::Population& population) const;
    // The places in use, in the order of the ids.
    [[nodiscard]] std::vector<PlaceRun> inUse() const;
    // Returns the number of places for a number of spheres.
    static std::uint32_t placesFor(std::uint32_t spheres);

  private:
    struct Taken {
        std::uint64_t id;
        std::uint32_t place;
    };

    std::vector<std::uint32_t> order_;
    std::vector<std::optional<std::uint64_t>> idAt_;  // by place; nullopt: free
    std::vector<Taken> taken_;                        // in the order of the ids
    std::uint32_t lowestFree_ = 0;                    // no place below it is free
};

}  // namespace spherule::encode

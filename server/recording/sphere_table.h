#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "core/result.h"
#include "spherule/v1/control.pb.h"

namespace spherule::recording {

// A column of a SphereTable that exports have, with its values by id.
struct ExportedColumn {
    std::string_view name;
    std::span<const std::int32_t> values;
};

// Data of the spheres that frames do not repeat, from scene facts and order. Any thread.
struct SphereTable {
    std::uint32_t epoch = 0;
    glm::dvec3 low{}, high{};                     // bounds, m
    glm::dvec3 periods{};                         // m: length of each periodic axis; 0: not periodic
    std::vector<float> radii;                     // by id, m
    std::vector<std::int32_t> groups, materials;  // by id: numbers in the scene, from 0; -1: the facts have none
    std::uint32_t order = 0;                      // number of the order
    std::vector<std::uint32_t> ids;               // in codec order

    [[nodiscard]] std::uint32_t spheres() const { return static_cast<std::uint32_t>(ids.size()); }
    // Returns the columns that all exports write behind id, position and radius. Valid as long as the table.
    [[nodiscard]] std::vector<ExportedColumn> exportedColumns() const;

    // Builds the table from messages that may be hostile. Allocates no more memory than they have. Input if they do not
    // fit each other.
    static Result<SphereTable> from(const v1::SceneFacts& facts, const v1::Order& order);
};

}  // namespace spherule::recording

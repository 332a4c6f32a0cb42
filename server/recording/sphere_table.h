#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/result.h"
#include "spherule/v1/control.pb.h"

namespace spherule::recording {

// Who plays in the frames: what scene facts and order say of the spheres. Any thread.
struct SphereTable {
    std::uint32_t epoch = 0;
    glm::dvec3 low{}, high{};        // bounds, m
    std::vector<float> radii;        // by id, m
    std::uint32_t order = 0;         // its number
    std::vector<std::uint32_t> ids;  // by place in the codec

    [[nodiscard]] std::uint32_t spheres() const { return static_cast<std::uint32_t>(ids.size()); }

    // From messages that may be hostile; takes no more memory than they have. Input where they do not fit each other.
    static Result<SphereTable> from(const v1::SceneFacts& facts, const v1::Order& order);
};

}  // namespace spherule::recording

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/memory.h"
#include "net/server.h"
#include "sim/state.h"
#include "spherule/v1/scene.pb.h"

namespace spherule::host {

// The text of a scene file with the state of a simulation. `ranks`: of the spheres of each group of `scene`, which has
// no spheres itself.
class SavedScene : public net::Document {
  public:
    // `centre`: of the bounds. `claim`: for the memory of the state.
    SavedScene(v1::Scene scene, std::vector<std::vector<std::uint32_t>> ranks, sim::State state, glm::dvec3 centre,
               memory::Claim claim);

    std::string next() override;

  private:
    [[nodiscard]] std::string beginOf(std::size_t group) const;
    void appendSphere(std::string& text, std::size_t rank) const;

    memory::Claim claim_;
    v1::Scene scene_;
    std::vector<std::vector<std::uint32_t>> ranks_;  // by group
    sim::State state_;
    glm::dvec3 centre_;
    bool begun_ = false;
    bool ended_ = false;
    std::size_t group_ = 0;  // under way
    std::size_t done_ = 0;   // spheres of it
};

}  // namespace spherule::host

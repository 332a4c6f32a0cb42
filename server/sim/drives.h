#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "scene/scene.h"
#include "sim/contact_sums.h"
#include "sim/obstacle_rows.h"
#include "sim/pipeline.h"

namespace spherule::sim {

// Integrates the driven bodies of a scene (scene/drive.h) from substep to substep, in double precision. The device sums
// what the spheres get from each body, as integers, so that each device gives the same bits.
//
// In `balanced`, spheres meet the body at the rate that it would have if its contacts gave what they hold. They move it
// as a body of finite mass (finish_substep.comp), and it moves at the rate after the contacts, as the spheres do. In
// `accurate`, spheres meet the body where it is at the end of the substep, and their forces change its rate.
class Drives {
  public:
    Drives(const scene::Scene& scene, const Plan& plan);

    [[nodiscard]] bool any() const { return !bodies_.empty(); }
    // Lets the states in the scene be those at a time (s simulated).
    void startAt(scene::Scene& scene, double time) const;
    // Sets the rates at which spheres meet the bodies in a substep. The states are those at its begin.
    void predict(scene::Scene& scene, const TimeSpan& substep);
    // Sets the states at the end of a substep that has been launched. Waits for the device.
    void advance(scene::Scene& scene, const TimeSpan& substep, Pipeline& pipeline, const LoadUnits& units);

    // Returns the states, in the order of the bodies.
    [[nodiscard]] std::vector<scene::Drive> states(const scene::Scene& scene) const;
    // Returns to such states, of as many bodies, at a time (s simulated).
    void restore(scene::Scene& scene, const std::vector<scene::Drive>& states, double time);
    // The data beyond the states. Loads only data of as many bodies.
    template <class Archive>
    void archive(Archive& a) {
        std::vector<Body> bodies = bodies_;
        a(bodies);
        if constexpr (Archive::loads) {
            if (bodies.size() != bodies_.size()) return a.refuse();
            for (std::size_t k = 0; k < bodies.size(); ++k) bodies[k].obstacle = bodies_[k].obstacle;
            bodies_ = std::move(bodies);
        }
    }

  private:
    struct Body {
        std::size_t obstacle = 0;
        double rate = 0;     // m/s or rad/s, at the begin of the substep
        double held = 0;     // N s or N m s, of the last substep
        double heldFor = 0;  // s, its length

        template <class Archive>
        void archive(Archive& a) {
            a(rate, held, heldFor);
        }
    };

    bool balanced_;
    std::size_t firstWord_;  // in Array::SurfaceSums
    std::vector<Body> bodies_;
    std::vector<std::uint32_t> words_;
};

// Returns the number of words of the rows of driven bodies in Array::SurfaceSums.
std::size_t driveSumWords(const scene::Scene& scene);

}  // namespace spherule::sim

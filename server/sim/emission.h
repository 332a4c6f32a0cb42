#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "scene/scene.h"
#include "sim/flow_meter.h"

namespace spherule::sim {

// The spheres that the emitters of a scene have made and are about to make. Everything follows from the scene and from
// which births were possible, so that all devices make the same spheres.
class Emission {
  public:
    Emission() = default;
    // Begins at this time (s simulated): spheres that were due before are not made.
    Emission(const scene::Scene& scene, double time);

    // Adds an emitter behind the others.
    void add(const scene::Emitter& emitter, double time);
    // Goes on with another emitter in the place of one. Its counts go on, its waiting spheres are not made.
    void replace(std::size_t number, const scene::Emitter& emitter, double time);
    void remove(std::size_t number);

    // Returns the spheres to make at the end of a step from `begin` to `end` (s simulated), where their present
    // attempts put them, at most MOST_BIRTH_PLACES. If more wait, those that have become due in this step come first.
    // Every emitter gets as many places as another one, or as many as it wants. Call settle() next.
    const std::vector<scene::Sphere>& attempt(const scene::Scene& scene, double begin, double end);
    // Tells which of these spheres have been made, in their order. All others wait for the next step, or count as
    // blocked if they have waited for mostAttempts steps. `time`: of the births (s simulated).
    void settle(const scene::Scene& scene, const std::vector<bool>& happened, double time);

    [[nodiscard]] std::size_t emitters() const { return emitters_.size(); }
    struct Counts {
        FlowMeter born;
        std::uint64_t blocked = 0;
        std::size_t waiting = 0;
        bool ended = false;  // it makes no more
    };
    [[nodiscard]] Counts counts(const scene::Scene& scene, std::size_t emitter) const;
    [[nodiscard]] std::vector<scene::EmitterProgress> progress(const scene::Scene& scene) const;  // by emitter
    template <class Archive>
    void archive(Archive& a) {
        a(emitters_);
    }

  private:
    struct Waiting {
        scene::Sphere sphere;
        std::uint64_t number = 0;
        double flight = 0;       // s from the time when it was due to the end of that step
        unsigned attempts = 0;   // steps that it has waited
        bool attempted = false;  // in this step

        template <class Archive>
        void archive(Archive& a) {
            a(sphere, number, flight, attempts, attempted);
        }
    };
    struct State {
        std::uint64_t next = 0;  // number of the next sphere to become due
        double massDue = 0;      // kg, of the spheres before it
        std::deque<Waiting> waiting;
        FlowMeter born;
        std::uint64_t blocked = 0;
        std::optional<double> chokedFrom;  // s of work: since then, no place was free
        bool choked = false;               // for so long that it has ended

        template <class Archive>
        void archive(Archive& a) {
            a(next, massDue, waiting, born, blocked, chokedFrom, choked);
        }
    };
    static bool hasEnded(const scene::Emitter& emitter, const State& state);
    static void followChoke(const scene::Emitter& emitter, State& state, bool free, double time);
    static void startAt(State& state, const scene::Emitter& emitter, double time);
    static void makeDue(const scene::Emitter& emitter, State& state, double begin, double end);
    static scene::Sphere birthOf(const Waiting& one, const scene::Emitter& emitter, const scene::Scene& scene);
    void choose();

    std::vector<State> emitters_;
    std::vector<scene::Sphere> births_;
};

}  // namespace spherule::sim

#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "compute/device.h"
#include "core/memory.h"
#include "scene/scene.h"
#include "sim/commands.h"
#include "sim/pipeline.h"
#include "sim/plan.h"
#include "sim/preparation.h"
#include "sim/state.h"
#include "sim/statistics.h"
#include "sim/tier.h"

namespace spherule::sim {

// Spheres in a scene on a device. Used by the thread that owns the device.
class Simulation {
  public:
    static Result<std::unique_ptr<Simulation>> create(compute::Device& device, scene::Scene scene);
    // Of a preparation that is done.
    static std::unique_ptr<Simulation> from(std::unique_ptr<Preparation> preparation);

    // One substep. True when it ends a step of scene().step seconds.
    Result<bool> advance();
    // To the end of the step.
    Result<void> step();
    // Between two substeps of one step.
    [[nodiscard]] bool midStep() const { return left_ > 0; }
    [[nodiscard]] double shareOfStep() const;  // of the step under way, that is done

    // The outcome of a command: it is done, or it needs `preparation`, which adopt() takes once that is done. Until
    // then nothing has changed, and no other call may change the simulation.
    struct Outcome {
        Applied applied{};
        std::unique_ptr<Preparation> preparation{};  // null: the command is done
    };
    // Refuses a command that cannot be carried out, and then changes nothing.
    Result<Outcome> begin(const Command& command);
    Applied adopt(std::unique_ptr<Preparation> preparation);
    // begin(), the whole preparation, and adopt().
    Result<Applied> apply(const Command& command);

    [[nodiscard]] Statistics statistics();
    // As they were in the last statistics().
    [[nodiscard]] const Impacts& impacts() const { return impacts_; }
    // Whether some steps are observed: they are, until this says otherwise. Never changes the state.
    void observe(bool on) { observing_ = on; }
    [[nodiscard]] State snapshot() { return inIdOrder(pipeline_->download()); }
    void put(const State& state);  // of as many spheres

    // Once counters().nonFinite: which sphere has left the numbers, since when, and how fast it was before.
    [[nodiscard]] std::string divergence() const;
    // Back to the last state that is known to be good: less than a simulated second old.
    void restore();

    // Where the positions lie now; until the next command.
    [[nodiscard]] TierSource tierSource();

    struct Counters {
        std::uint32_t pairs = 0;           // listed
        std::uint32_t unlisted = 0;        // cell groups without room for their pairs; served, but slowly
        std::uint32_t sampled = 0;         // cell groups so crowded that only some of their pairs are listed
        std::uint32_t forgotten = 0;       // contacts with walls that found no room for what they remember
        bool nonFinite = false;            // some sphere has left the numbers,
        std::uint32_t firstNonFinite = 0;  // this one of them, by id
        std::uint32_t rebuilds = 0;        // of the lists, since the last change of the scene
        double farthest = 0;               // largest motion in a substep of the step, in radii; 0: less than FAR_MOTION
    };
    [[nodiscard]] const Counters& counters() const { return counters_; }  // as of the end of the last step

    // Of the next step: those of the scene, or more while something moves too far in one of them.
    [[nodiscard]] std::uint32_t substeps() const { return substeps_; }

    // Changes the substeps of the steps to come to what the scene's goal needs; disturbs nobody.
    Result<void> chooseSubsteps(std::uint32_t substeps);

    // What users should hear of, in sentences, since the last call.
    [[nodiscard]] std::vector<std::string> takeNotices() { return std::exchange(notices_, {}); }

    // Device seconds per Pass since the last call. Waits for the device.
    [[nodiscard]] std::vector<double> passSeconds() { return device_.takeTimes(); }

    [[nodiscard]] const scene::Scene& scene() const { return scene_; }
    [[nodiscard]] const Radii& radii() const { return radii_; }
    [[nodiscard]] const Plan& plan() const { return pipeline_->plan(); }
    [[nodiscard]] Pipeline& pipeline() { return *pipeline_; }
    [[nodiscard]] std::uint32_t count() const { return plan().spheres; }
    [[nodiscard]] std::uint64_t steps() const { return steps_; }
    [[nodiscard]] double time() const;                                      // s simulated
    [[nodiscard]] std::uint32_t generation() const { return generation_; }  // changes when spheres or obstacles do

  private:
    explicit Simulation(compute::Device& device) : device_(device) {}

    // What adopting a preparation begins anew, beside arrays and kernels. In each, everybody wakes.
    enum class Anew : std::uint8_t { Nothing, Spheres, World };

    void take(Preparation& preparation);
    // `copies` are those that are made for it, beside what it claims itself.
    Outcome prepare(Anew anew, memory::Claim copies, Preparation::Build build);
    Outcome prepare(Anew anew, memory::Claim copies, Built built);
    Result<State> liveState();  // DeviceLost, rather than what a lost device gives
    void useSubsteps(std::uint32_t substeps);
    Result<void> guard();
    void readCounters();
    void makeRoom();
    void uploadParameters();
    void fitToMotion(double radiiPerSubstep);
    void keep();

    class CommandHandler;
    Result<Outcome> change(scene::Scene changed, bool disturbs);

    compute::Device& device_;
    memory::Claim claim_;
    scene::Scene initial_;
    scene::Scene scene_;
    Radii radii_;
    std::unique_ptr<Pipeline> pipeline_;
    Counters counters_;
    bool observing_ = true;
    Impacts impacts_;
    bool forgot_ = false;   // it has been said that contacts forget
    bool full_ = false;     // there is no room for more pairs
    bool sampled_ = false;  // it has been said that not all pairs are listed
    std::uint32_t substeps_ = 1;
    std::uint32_t mostSubsteps_ = 1;  // while something is very fast
    std::uint32_t calm_ = 0;          // steps since something moved too far
    std::uint32_t patience_ = 0;      // steps of calm before substeps are lowered
    bool lowered_ = false;            // since then
    std::vector<std::string> notices_;
    SlotState good_;  // the last one that was found finite
    std::uint64_t goodStep_ = 0;
    std::uint64_t steps_ = 0;
    // The step under way: so much of it was done when its substeps were last chosen; then how many, how many are left.
    double begun_ = 0;
    std::uint32_t chosen_ = 0;
    std::uint32_t left_ = 0;
    bool observed_ = false;
    Anew anew_ = Anew::Nothing;  // of the preparation under way
    std::uint32_t generation_ = 0;
};

}  // namespace spherule::sim

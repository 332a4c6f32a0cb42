#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <thread>

#include "compute/device.h"
#include "core/memory.h"
#include "core/progress.h"
#include "core/result.h"
#include "scene/scene.h"
#include "sim/commands.h"
#include "sim/initial_overlaps.h"
#include "sim/pipeline.h"
#include "sim/radius_stats.h"
#include "sim/state.h"

namespace spherule::sim {

class Simulation;

// A scene and the initial state of its spheres, in id order.
struct SceneAndState {
    scene::Scene scene;
    State state;
};

// Returns the scene and its initial state. Refused if there is no memory for the state.
Result<SceneAndState> withInitialState(scene::Scene scene);

// Prepares all that a simulation needs: arrays, kernels, the spheres on the device. Works in pieces, so that another
// simulation can go on stepping on the same device. Used by the thread that owns the device.
class Preparation {
  public:
    using Build = std::function<Result<SceneAndState>(Progress&)>;

    // `copies`: the caller's memory claim for `built` or `build`, released with the preparation.
    Preparation(compute::Device& device, SceneAndState built, memory::Claim copies = {});
    // `build` runs on a thread of its own and may not use the device. An exception in it, such as bad_alloc, becomes an
    // error.
    Preparation(compute::Device& device, Build build, memory::Claim copies = {});
    // The same, to add spheres to a simulation. If its arrays and kernels suit them, only the arrays grow.
    Preparation(compute::Device& device, Build build, memory::Claim copies, Simulation& addsTo);
    // A change of an obstacle.
    struct ObstacleEdit {
        std::uint32_t number = 0;
        std::vector<scene::Obstacle> places{};                 // the obstacle before and after, as far as it exists
        std::vector<std::optional<std::uint32_t>> surfaces{};  // the new number of each surface; nullopt: it is gone
    };
    // To go on with other obstacles: the spheres of the simulation stay as they are.
    Preparation(scene::Scene changed, memory::Claim copies, Simulation& continues, ObstacleEdit edit);
    // To go on with another field, emitter, material or group. The simulation may step and change its spheres
    // meanwhile: the last piece carries out the change on the scene as it is then.
    Preparation(scene::Scene changed, memory::Claim copies, Simulation& continues, ChangePart change);
    // Cancels `build` and waits for its thread.
    ~Preparation();
    Preparation(const Preparation&) = delete;
    Preparation& operator=(const Preparation&) = delete;

    // Does one piece of about the length of a substep, or waits up to `maxWait` for the thread that builds. Returns
    // true once all is done and Simulation may adopt the preparation. Do not call it again after that or after an
    // error.
    Result<bool> advance(std::chrono::milliseconds maxWait = std::chrono::milliseconds(0));
    // Does all remaining pieces.
    Result<void> finish();

    // Returns true if the simulation may step before the next piece. Near the end of a preparation it may not any more.
    [[nodiscard]] bool letsStep() const { return change_.has_value() && !holds_; }
    [[nodiscard]] Progress::Seen progress() const { return progress_.seen(); }

    // The result of moving spheres apart that overlapped deeply at the start.
    struct ResolvedOverlaps {
        double before = 0;  // largest overlap, as a fraction of the smaller radius
        double after = 0;
        std::uint32_t sweeps = 0;
    };

  private:
    friend class Simulation;
    enum class Stage : std::uint8_t {
        Building,
        Planning,
        Allocating,
        Uploading,
        MeasuringOverlaps,
        ResolvingOverlaps,
        Done
    };

    // The plan follows from this and from the scene. For a change beside the world, it is of the present state.
    struct Basis {
        bool keepsGrid = false;  // the cells, the handles and the memory of contacts stay
        Features features;
        RadiusStats radii;
        std::uint32_t spheres = 0;  // with new cells
        std::uint32_t room = 0;     // without
        std::uint32_t pairCapacity = 0;

        bool operator==(const Basis&) const = default;
    };

    Result<void> doStage(std::chrono::milliseconds maxWait);
    Result<void> awaitBuilt(std::chrono::milliseconds maxWait);
    Result<void> makePlan();
    [[nodiscard]] Basis basis() const;
    Result<Plan> planNow();
    Result<void> startPipeline(Plan plan, MadeKernels kernels);
    Result<void> makeNext();
    void upload();
    Result<void> measureOverlaps();
    Result<void> resolveOverlaps();
    Result<void> meetPresent();
    Result<void> planAgain();

    compute::Device& device_;
    memory::Claim copies_;
    memory::Claim claim_;  // for the simulation that it makes
    Progress progress_;
    std::uint64_t seenMarks_ = 0;  // progress marks of the thread that builds, as last seen
    std::future<Result<SceneAndState>> building_;
    Stage stage_ = Stage::Building;
    SceneAndState built_;
    Basis basis_;
    std::unique_ptr<Pipeline> pipeline_;  // null: the simulation keeps its own
    Simulation* addsTo_ = nullptr;
    bool appends_ = false;  // the simulation takes the new spheres as they are
    Simulation* continues_ = nullptr;
    ObstacleEdit edit_;
    std::optional<ChangePart> change_;
    scene::PartChange made_;
    unsigned plans_ = 0;     // that were made
    bool holds_ = false;     // the simulation may not step any more
    double maxOverlap_ = 0;  // largest overlap allowed, as a fraction of the smaller radius
    std::unique_ptr<InitialOverlapResolver> resolver_;
    std::optional<ResolvedOverlaps> resolvedOverlaps_;
    std::jthread builder_;  // last member: joined before the members that it uses are destroyed
};

}  // namespace spherule::sim

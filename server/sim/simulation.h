#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compute/device.h"
#include "core/memory.h"
#include "scene/scene.h"
#include "sim/commands.h"
#include "sim/drives.h"
#include "sim/flows.h"
#include "sim/obstacle_rows.h"
#include "sim/pipeline.h"
#include "sim/plan.h"
#include "sim/population.h"
#include "sim/preparation.h"
#include "sim/saved_state.h"
#include "sim/state.h"
#include "sim/statistics.h"

namespace spherule::sim {

// A simulation of a scene on a device. Used by the thread that owns the device.
class Simulation {
  public:
    static Result<std::unique_ptr<Simulation>> create(compute::Device& device, scene::Scene scene);
    // Makes a simulation from a preparation that is done.
    static std::unique_ptr<Simulation> from(std::unique_ptr<Preparation> preparation);

    // Makes a simulation that goes on from a saved state with the same bits, on a device of the same kind. Input if it
    // is no such state, or if it is of another version of the program.
    static Result<std::unique_ptr<Simulation>> restore(compute::Device& device, const SavedState& saved);
    // Returns the present state. Refused between two substeps of one step, and if there is no memory for it. Waits for
    // the device.
    Result<SavedState> save();

    // Does one substep. Returns true if it ends a step of scene().step seconds.
    Result<bool> advance();
    // Does the remaining substeps of the step.
    Result<void> step();
    // Returns true between two substeps of one step.
    [[nodiscard]] bool midStep() const { return substepsLeft_ > 0; }
    [[nodiscard]] double shareOfStep() const;  // share of the step under way that is done, 0 to 1
    [[nodiscard]] std::uint32_t substepsDone() const { return substepsDone_; }  // of the step under way

    // The outcome of a command: it is done, or it needs `preparation`. Pass the preparation to adopt() once it is done.
    // Until then the command has changed nothing. The simulation may go on while Preparation::letsStep(), and otherwise
    // no other call may change it.
    struct Outcome {
        Applied applied{};
        std::unique_ptr<Preparation> preparation{};  // null: the command is done
    };
    // Begins a command. An error leaves the simulation unchanged.
    Result<Outcome> begin(const Command& command);
    Applied adopt(std::unique_ptr<Preparation> preparation);
    // Does begin(), the whole preparation, and adopt().
    Result<Applied> apply(const Command& command);

    [[nodiscard]] Statistics statistics();
    // Returns the impacts as of the last call of statistics().
    [[nodiscard]] const Impacts& impacts() const { return impacts_; }
    // Returns the contact sums so far, with a dissipated energy that lacks the change of the energy in springs. Waits
    // for the device.
    [[nodiscard]] const ContactSums& readContactSums() {
        takeContactSums();
        return contactSums_;
    }
    // Turns observed steps on or off. Default: on. Observing never changes the state.
    void observe(bool on) { observing_ = on; }
    [[nodiscard]] State snapshot() { return inIdOrder(pipeline_->download(), population_); }
    void upload(const State& state);  // `state` has count() spheres
    // Returns the number of spheres, walls and obstacles that each sphere touches, in the order of ids: see Pipeline.
    [[nodiscard]] std::vector<std::uint32_t> contactCounts();

    // Describes the non-finite sphere with the smallest handle: its last finite position and speed. Call it only if
    // counters().nonFinite.
    [[nodiscard]] std::string divergence() const;
    // Returns to the last state that was found finite. States are kept about once per simulated second.
    void rollback();

    // Returns an array on the device; null if the plan has none. Valid until the next command.
    [[nodiscard]] compute::Buffer* buffer(Array array);

    struct Counters {
        std::uint32_t pairs = 0;                // listed
        std::uint32_t unlisted = 0;             // cell groups without room for their pairs; served, but slowly
        std::uint32_t sampled = 0;              // spheres of which only a sample of the pairs is listed
        std::uint32_t cutShort = 0;             // lists of cell groups that the renderer cut short, since the start
        std::uint32_t droppedWallContacts = 0;  // contacts with walls that found no room for their slip
        bool nonFinite = false;                 // some sphere has become non-finite
        std::uint32_t firstNonFinite = 0;       // the smallest handle of such a sphere
        std::uint32_t rebuilds = 0;             // of the lists, since the last change of the scene
        std::uint32_t sunk = 0;                 // spheres in sinks
        double largestMotion = 0;               // largest motion in a substep of the step (radii); 0: below SAFE_MOTION

        template <class Archive>
        void archive(Archive& a) {
            a(pairs, unlisted, sampled, cutShort, droppedWallContacts, nonFinite, firstNonFinite, rebuilds, sunk,
              largestMotion);
        }
    };
    [[nodiscard]] const Counters& counters() const { return counters_; }  // as of the end of the last step

    // Returns the substeps of the next step: the scene's number, or more while a sphere moves too far in a substep.
    [[nodiscard]] std::uint32_t substeps() const { return substeps_; }

    // Sets the number of substeps that the scene's goal requires, also for the rest of a step under way. Wakes no
    // sphere.
    Result<void> chooseSubsteps(std::uint32_t substeps);

    // Returns the notices for users since the last call, each a sentence.
    [[nodiscard]] std::vector<std::string> takeNotices() { return std::exchange(notices_, {}); }

    // Returns the device time (s) per Pass since the last call, while timers were used. Waits for the device.
    [[nodiscard]] std::vector<double> passSeconds() { return device_.takeTimes(); }

    [[nodiscard]] const scene::Scene& scene() const { return scene_; }
    [[nodiscard]] const RadiusStats& radii() const { return radii_; }
    // The impulse (N s) that would give a sphere of the largest radius and the largest density the largest speed that
    // the scene can compute. A push with a larger one is refused for every sphere at rest.
    [[nodiscard]] double maxImpulse() const;
    // Ends the pull of the session, if it has one.
    void release(std::uint64_t session);
    [[nodiscard]] bool pulling() const { return !pulls_.empty(); }
    // Returns the sessions that pull a sphere.
    [[nodiscard]] std::vector<std::uint64_t> pullingSessions() const;
    [[nodiscard]] const Plan& plan() const { return pipeline_->plan(); }
    [[nodiscard]] Pipeline& pipeline() { return *pipeline_; }
    [[nodiscard]] std::uint32_t count() const { return population_.count(); }
    // Ids, ranks and handles of the spheres. scene().spheres is in the order of ids too.
    [[nodiscard]] const Population& population() const { return population_; }
    [[nodiscard]] const Flows& flows() const { return flows_; }
    // Counts births from `id` on. Only before a sphere was added or removed.
    void setFirstId(std::uint64_t id) { population_ = Population(count(), id); }
    [[nodiscard]] std::uint64_t steps() const { return steps_; }
    [[nodiscard]] double time() const;                                      // s simulated
    [[nodiscard]] std::uint32_t generation() const { return generation_; }  // changes with the spheres or obstacles
    // Grows when fields, emitters, materials or groups may have changed.
    [[nodiscard]] std::uint64_t partsVersion() const { return partsVersion_; }
    // Grows when the names of materials, or groups beside their spheres, have changed.
    [[nodiscard]] std::uint64_t groupsVersion() const { return groupsVersion_; }

  private:
    explicit Simulation(compute::Device& device) : device_(device) {}

    // The data that adopt() resets in addition to arrays and kernels. All spheres wake in each case.
    enum class ResetScope : std::uint8_t { Nothing, Spheres, World };

    void install(Preparation& preparation);
    // `copies`: the claim for copies made for the preparation, in addition to the preparation's own claim.
    Outcome prepareSpawn(memory::Claim copies, Preparation::Build build);
    Outcome prepare(ResetScope scope, memory::Claim copies, SceneAndState built);
    friend class Preparation;
    [[nodiscard]] bool canAppend(const scene::Scene& grown) const;
    Result<void> makeRoomFor(std::uint32_t spheres);
    [[nodiscard]] bool fitsPlan(std::uint64_t spheres) const;
    void append(Preparation& preparation);
    void append(std::span<const scene::Sphere> added);
    void emit();
    std::vector<bool> freePlaces(std::span<const scene::Sphere> births);
    Result<void> addBorn(std::span<const scene::Sphere> born);
    Result<void> remove(const std::vector<std::uint32_t>& ranks);
    void emptySinks();
    void keepLastFinite();
    Result<State> liveState();  // DeviceLost if the device is lost, because its data is invalid
    void useSubsteps(std::uint32_t substeps);
    Result<void> checkStep();
    void readCounters();
    void growPairs();
    void uploadParameters();
    [[nodiscard]] double maxSpeed(double radius) const;
    // A spring between a sphere and a point, which a session holds.
    struct PullSpring {
        std::uint64_t session = 0;
        std::uint64_t sphere = 0;  // id
        glm::dvec3 point{};        // m
        double stiffness = 0;      // N/m

        template <class Archive>
        void archive(Archive& a) {
            a(session, sphere, point, stiffness);
        }
    };
    Result<glm::dvec3> pull(const Pull& pull, std::uint32_t rank);
    [[nodiscard]] double rateOf(const PullSpring& spring, std::uint32_t rank) const;
    Result<void> writePulls();
    void keepPulls();
    struct PullLimits {
        double speed = 0;         // m/s
        double acceleration = 0;  // m/s^2
    };
    [[nodiscard]] PullLimits pullLimits(double radius) const;
    [[nodiscard]] glm::dvec3 forceOf(const PullSpring& spring, std::uint32_t rank);
    Result<Outcome> changeObstacle(const ChangeObstacle& change);
    Result<void> checkWay(const scene::Obstacle& obstacle, const scene::Obstacle* before, const State& state) const;
    void continueWith(Preparation& preparation);
    Result<void> checkFinite();
    Result<Outcome> changePart(const ChangePart& change);
    Result<Outcome> removeGroup(const RemoveGroup& remove);
    [[nodiscard]] bool keepsGrid(const scene::Scene& changed) const;
    [[nodiscard]] bool keepsKernels(const scene::Scene& changed) const;
    void takePart(scene::Scene changed, const scene::PartChange& change, Preparation* preparation);
    bool takePipeline(Preparation& preparation, const scene::Scene& changed);
    void wakeWhere(const scene::Forces& before);
    void wakeAt(const std::vector<scene::Obstacle>& obstacles);
    [[nodiscard]] TimeSpan nextSubstep() const;
    void placeObstacles(double framesAt);
    [[nodiscard]] double motionOfObstacles() const;
    void limitMotionPerSubstep(double radiiPerSubstep);
    void limitMotionOf(const State& state);
    void saveLastFinite();
    void takeContactSums();
    void closeContactSums();
    void openContactSums();
    [[nodiscard]] bool hasContactSums() const { return plan().features.has(Feature::ContactSums); }

    template <class Archive>
    void archive(Archive& a);

    class CommandHandler;
    Result<Outcome> change(scene::Scene changed, bool disturbs);

    compute::Device& device_;
    memory::Claim claim_;
    scene::Scene initial_;
    scene::Scene scene_;
    RadiusStats radii_;
    std::optional<ObstacleRows> obstacleRows_;
    std::optional<Drives> drives_;
    std::unique_ptr<Pipeline> pipeline_;
    Population population_;
    Flows flows_;
    Counters counters_;
    bool observing_ = true;
    Impacts impacts_;
    // dissipated: without the change of the energy in springs since openContactSums().
    ContactSums contactSums_;
    LoadUnits loadUnits_;
    ContactSums lastFiniteSums_;
    double sumsBegin_ = 0;           // s simulated
    double elasticBefore_ = 0;       // J, in springs at openContactSums()
    bool noticedDropped_ = false;    // a notice about dropped wall contacts was given
    bool pairsExhausted_ = false;    // no room for more pairs
    bool noticedSampled_ = false;    // a notice about sampled pairs was given
    bool noticedCutShort_ = false;   // a notice about lists that were cut short was given
    bool noticedFullSinks_ = false;  // a notice about sinks without memory was given
    bool noticedNoRoom_ = false;     // a notice about emitters without room was given
    std::uint32_t substeps_ = 1;
    std::uint32_t maxSubsteps_ = 1;  // limit while a sphere is very fast
    std::uint32_t quietSteps_ = 0;   // steps since a sphere moved too far
    std::uint32_t backoff_ = 0;      // quiet steps before substeps are lowered
    bool lowered_ = false;           // since a sphere last moved too far
    bool tooFast_ = false;           // notice was given that the most substeps are too few
    std::vector<PullSpring> pulls_;
    std::vector<std::string> notices_;
    std::uint64_t lastFiniteStep_ = 0;  // of the last state that was found finite, which the pipeline keeps
    std::vector<scene::Drive> lastFiniteDrives_;
    Flows lastFiniteFlows_;
    // The spheres of that state, kept when spheres are added or removed after it.
    struct Spheres {
        Population population;
        std::vector<scene::Sphere> spheres;
        std::vector<scene::Group> groups;

        template <class Archive>
        void archive(Archive& a) {
            a(population, spheres, groups);
        }
    };
    std::optional<Spheres> lastFiniteSpheres_;
    std::uint64_t steps_ = 0;
    // The step under way, and its remainder since its substeps were last chosen. remainderBegin_: the share of the step
    // that was done then. remainderSubsteps_: the substeps of the remainder. substepsLeft_: those that remain.
    double remainderBegin_ = 0;
    std::uint32_t remainderSubsteps_ = 0;
    std::uint32_t substepsLeft_ = 0;
    std::uint32_t substepsDone_ = 0;
    bool stepObserved_ = false;
    ResetScope resetScope_ = ResetScope::Nothing;  // for the preparation under way
    std::uint32_t generation_ = 0;
    std::uint64_t partsVersion_ = 0;
    std::uint64_t groupsVersion_ = 0;
};

}  // namespace spherule::sim

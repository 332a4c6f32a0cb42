#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compute/device.h"
#include "sim/layout.h"
#include "sim/plan.h"
#include "sim/population.h"
#include "sim/state.h"

namespace spherule::sim {

// The state of the spheres in slot order, as the device stores it. Columns without an array on the device are empty.
// Positions may be outside the bounds along periodic axes.
struct SlotState : SphereColumns {
    std::vector<std::uint32_t> idAndMaterial;
    std::vector<glm::uvec4> images;  // with periodic axes, by id: signed
    glm::dvec3 periods{};            // m, as Bounds::periods() returns them
};

// Returns the state of the spheres in the order of their ids, with positions inside the bounds along periodic axes.
State inIdOrder(const SlotState& slots, const Population& population);

// Returns the arrays to bind for a launch, in the order of the buffers that its kernel declares. NoDevice for a buffer
// without an array, for a buffer whose type differs from its array, and for an alias that the kernel does not declare.
Result<std::vector<Array>> arraysFor(const LaunchSpec& launch, const compute::Kernel& kernel);

// Kernels that were made, for pipelines with the same features.
struct MadeKernels {
    std::vector<std::string_view> files;
    std::vector<std::unique_ptr<compute::Kernel>> kernels;
};

// A plan on a device: its arrays and its kernels. Used by the thread that owns the device.
class Pipeline {
  public:
    // Handles are below this number. A word of the array IdAndMaterial has the handle in the low bits.
    static constexpr std::uint32_t idBits = 24;
    static constexpr std::uint32_t mostHandles = 1U << idBits;
    static constexpr std::uint32_t idMask = mostHandles - 1;

    // Makes neither arrays nor kernels: makeNext() does. Those in `made` are not made again.
    Pipeline(compute::Device& device, Plan plan, MadeKernels made = {});
    // Returns the kernels. The pipeline cannot be used any more.
    MadeKernels takeKernels();

    // Makes one more array or kernel. Returns false once all exist.
    Result<bool> makeNext();
    [[nodiscard]] double shareMade() const;  // of arrays and kernels, 0 to 1

    // Scales what contacts hold if the length of the substep has changed.
    void setParameters(layout::Parameters parameters);
    // Uploads the spheres, at most plan().room. `state` and `materials` are in id order. `handles`: the handle of each
    // sphere, below plan().room; empty: 0, 1, ... The lists are rebuilt in the next substep.
    void upload(const State& state, std::span<const std::uint8_t> materials,
                std::span<const std::uint32_t> handles = {});
    [[nodiscard]] SlotState download();  // waits for the device
    // Keeps a copy of the state on the device.
    void keepState();
    // Returns the state that was kept last, when there were `spheres` spheres. Waits for the device.
    [[nodiscard]] SlotState keptState(std::uint32_t spheres);

    // Adds spheres behind the present ones, for which there must be room. They wake the sleepers within reach. Their
    // lists are built in the next substep. Call setParameters() next.
    void append(const State& born, std::span<const std::uint8_t> materials, std::span<const std::uint32_t> handles);
    // Removes the spheres with these handles, wakes the sleepers within their reach, and rebuilds the lists. Call
    // setParameters() next. Waits for the device. Refused, with the state unchanged, if there is no memory for it.
    Result<void> remove(std::span<const std::uint32_t> handles);
    // Makes room for more spheres. Refused, with the spheres unchanged, if there is no memory for it.
    Result<void> growSpheres(std::uint32_t room, const scene::Scene& scene);

    // Returns the new key of a contact with an obstacle (shaders/shared/surfaces.h); nullopt: the contact has ended.
    using NewKey = std::function<std::optional<std::uint32_t>(std::uint32_t key)>;
    // Takes over the state of a pipeline of other obstacles with the same spheres and cells: see planAsOf(). Both have
    // room for the same number of spheres and pairs. The lists are rebuilt in the next substep. Waits for the device.
    void takeFrom(Pipeline& before, const NewKey& newKey);
    // The same for a pipeline of other features with the same obstacles. The lists stay if contacts remember the same.
    void takeFrom(Pipeline& before);
    // Makes the array SlotOf, which pipelines without contacts lack until a sphere is removed.
    Result<void> makeSlotOf();
    // Gives the spheres other materials and masses. `materials` and `inverseMasses` (1/kg, 0 if fixed) are by handle.
    // The impulses that
    // contacts hold stay. Waits for the device.
    void setMaterials(std::span<const std::uint8_t> materials, std::span<const float> inverseMasses);
    // Wakes the spheres with these handles. Waits for the device.
    void wake(std::span<const std::uint32_t> handles);
    // Makes new lists of all spheres in the next substep.
    void requestRebuild();

    // The data on the host that decides which launches follow.
    struct LaunchState {
        bool listsPending = false;
        bool impactsPending = false;
        bool launchesRebuild = true;
        bool listsMayBeMissing = true;
        bool moversMayExist = true;
        float substepLength = 0;                    // s
        unsigned unforeseen = 0;                    // substeps
        std::uint32_t unlistedBirths = 0;           // spheres
        std::vector<std::uint32_t> rebuildWords{};  // of the last substeps

        template <class Archive>
        void archive(Archive& a) {
            a(listsPending, impactsPending, launchesRebuild, listsMayBeMissing, moversMayExist, substepLength,
              unforeseen, unlistedBirths, rebuildWords);
        }
    };
    // Between two steps. Waits for the device.
    [[nodiscard]] LaunchState launchState();
    void restore(const LaunchState& state);
    // An array that holds more than scratch between two steps.
    struct SavedArray {
        Array array{};
        std::vector<std::byte> bytes{};
    };
    // Waits for the device.
    [[nodiscard]] std::vector<SavedArray> saveArrays();
    // Uploads such arrays of a pipeline with an equal plan, and makes those that were made later. Input if they are
    // arrays of another plan.
    Result<void> restore(const std::vector<SavedArray>& arrays, const scene::Scene& scene);

    void substep(bool observed = false);
    // Runs the launches at the end of a step.
    void endStep() { run(stepEnd_, LaunchSet::Substep); }
    // Returns the impacts in the observed steps since the last call: one sum per bundle, as statistics_impacts.comp
    // adds them up. Empty if no step was observed. Waits for the device.
    std::vector<glm::vec4> takeImpacts();
    void runStatistics();  // of the current state; builds its lists first if they are out of date
    // Returns the number of spheres, walls and obstacles that each sphere touches, by handle. Bodies touch up to a gap
    // of 1e-4 of the sum of the radii, or of 2e-4 of the radius at walls and obstacles. Waits for the device.
    std::vector<std::uint32_t> contactCounts();

    // Computes the contacts, the overlap and the energy of each sphere in the present state, see figures.comp. Returns
    // the array with them, by slot; it is valid until the simulation changes or goes on. The first call makes what is
    // needed for it.
    Result<compute::Buffer*> figures();
    // Returns what the sphere touches, as the array Inspected has it. Waits for the device. Likewise.
    Result<std::vector<std::uint32_t>> inspect(std::uint32_t handle);
    // Returns the row of a sphere in a column; zero if the plan has no such column. Waits for the device.
    template <class T>
    T rowOf(std::uint32_t handle, Array column) {
        T row{};
        if (plan_.has(column))
            device_.download(buffer(column), slotOf(handle) * sizeof row, std::as_writable_bytes(std::span(&row, 1)));
        return row;
    }

    // Returns an array as elements of T, at most `most` from `first` on. Empty if the plan has no such array. Waits for
    // the device.
    template <class T>
    std::vector<T> read(Array array, std::size_t most = SIZE_MAX) {
        std::vector<T> values;
        readInto(values, array, most);
        return values;
    }
    template <class T>
    void readInto(std::vector<T>& values, Array array, std::size_t most = SIZE_MAX, std::size_t first = 0) {
        const std::size_t all = static_cast<std::size_t>(plan_.bytesOf(array)) / sizeof(T);
        values.resize(std::min(all - std::min(first, all), most));
        if (!values.empty())
            device_.download(buffer(array), first * sizeof(T), std::as_writable_bytes(std::span(values)));
    }
    template <class T>
    void write(Array array, std::span<const T> values, std::size_t first = 0) {
        device_.upload(buffer(array), first * sizeof(T), std::as_bytes(values));
    }

    // Wakes a sphere and gives it an impulse (N s). Waits for the device.
    void applyImpulse(std::uint32_t handle, glm::vec3 impulse);
    [[nodiscard]] glm::vec4 velocityOf(std::uint32_t handle);  // waits for the device

    // Sets the springs that pull spheres in each substep, at most MOST_PULLS. Refused if there is no memory for it.
    Result<void> setPulls(std::span<const glm::vec4> rows);
    // Position (m, relative to the centre of the bounds) and radius of a sphere. Waits for the device.
    [[nodiscard]] glm::vec4 positionOf(std::uint32_t handle);

    // Makes what takenPlaces() needs, unless it exists.
    Result<void> makeBirths();
    // Returns for each place for a new sphere (position relative to the centre of the bounds, and radius, m) whether a
    // sphere overlaps it; at most MOST_BIRTH_PLACES. makeBirths() must have been called. Waits for the device.
    std::vector<bool> takenPlaces(std::span<const glm::vec4> places);

    // Wakes all spheres. Waits for the device.
    void wakeAll();

    // Makes room for more pairs. The lists are rebuilt in the next substep.
    Result<void> growPairs(std::uint32_t capacity);

    // Returns the number of kernels launched since the pipeline was made.
    [[nodiscard]] std::uint64_t launches() const { return launches_; }
    // Returns how many batches of pairs follow one another in a substep with the present lists: the most that a bundle
    // of each colour has, added up. A pair without a batch counts as one. Waits for the device.
    [[nodiscard]] std::uint32_t longestChain();

    [[nodiscard]] const Plan& plan() const { return plan_; }
    [[nodiscard]] compute::Buffer& buffer(Array array) { return *buffers_[static_cast<std::size_t>(array)]; }

  private:
    Result<void> makeSmallArrays();
    Result<void> makeArray(const ArraySpec& spec);
    Result<void> makeKernel(std::string_view file);
    void writeDispatchSizes();
    SlotState slotState(std::uint32_t spheres, Array (*of)(Array));
    void writeColumns(const State& state, std::size_t first = 0);
    std::uint32_t slotOf(std::uint32_t handle);
    void setSpheres(std::uint32_t count);
    void takeWallMemory(Pipeline& before, const NewKey& newKey);
    void rebuildLists();
    void buildListsToRead();
    void expectRebuild();
    void placeFarSlot();
    // Launches the kernels of a rebuild in the next substeps: the speeds, or the length of the substep, have changed.
    void awaitSpeeds() { unforeseen_ = std::max(unforeseen_, substepsAhead); }
    void chooseLaunches();
    void startWords(std::span<const std::uint32_t> words);
    void clearRows(Array array, std::size_t first, std::size_t count);
    void wakeNeighbours(const std::vector<bool>& gone, std::span<const std::uint32_t> words);
    [[nodiscard]] bool hasListsAs(const Pipeline& before) const;
    Result<void> makeMissing(Array array, std::uint64_t elements);
    Result<void> makePulls();
    void moveLastInto(std::vector<std::uint32_t> slots);
    [[nodiscard]] std::size_t rowBytes(Array array) const;
    void setBuffer(Array array, std::unique_ptr<compute::Buffer> made);
    // A launch of the plan, its kernel, and the arrays to bind by slot.
    struct BoundLaunch {
        const LaunchSpec* spec = nullptr;
        const compute::Kernel* kernel = nullptr;
        std::vector<Array> arrays;
    };
    Result<BoundLaunch> bind(const LaunchSpec& spec);
    Result<void> bindAll();
    Result<void> bindLate(const std::vector<LaunchSpec>& launches, std::vector<BoundLaunch>& bound);
    enum class LaunchSet : std::uint8_t { Substep, ObservedSubstep, Rebuild, Waking };
    void run(const std::vector<BoundLaunch>& launches, LaunchSet set);

    compute::Device& device_;
    Plan plan_;
    std::vector<std::string_view> kernelFiles_;  // the files of kernels_ first, in its order
    std::size_t arraysMade_ = 0;                 // of plan_.arrays
    bool listsPending_ = false;
    bool listsRead_ = false;  // while they are pending: lists of the present state were built to read it
    bool impactsPending_ = false;
    std::array<std::unique_ptr<compute::Buffer>, arrayCount> owned_;
    // For an array that the plan lacks: absent_, which no kernel accesses.
    std::array<compute::Buffer*, arrayCount> buffers_{};
    std::unique_ptr<compute::Buffer> absent_;
    std::unique_ptr<compute::Buffer> parameters_;
    std::vector<std::unique_ptr<compute::Kernel>> kernels_;
    std::vector<BoundLaunch> substep_, newSubstep_, statistics_, stepEnd_;
    std::vector<BoundLaunch> figures_, inspection_;  // empty until they are first needed
    const LaunchSpec pullSpec_{.pass = Pass::Integrate, .kernel = "pull.comp", .count = MOST_PULLS};
    std::vector<BoundLaunch> pulls_;   // empty until a sphere is pulled
    std::vector<BoundLaunch> births_;  // empty until a sphere is to be born
    bool pulling_ = false;
    float substepLength_ = 0;                     // s; 0: none yet
    static constexpr unsigned substepsAhead = 2;  // that the host launches before it needs COUNTER_REBUILD of the first
    std::unique_ptr<compute::WordQueue> rebuildWords_;  // COUNTER_REBUILD at the end of the last substeps
    unsigned unforeseen_ = 0;      // substeps for which COUNTER_REBUILD does not tell whether a rebuild may be due
    bool launchesRebuild_ = true;  // in this substep
    bool listsMayBeMissing_ = true;
    bool moversMayExist_ = true;
    std::uint32_t unlistedBirths_ = 0;  // spheres that were added since the last substep
    std::uint64_t launches_ = 0;
};

}  // namespace spherule::sim

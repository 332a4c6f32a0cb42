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
#include "sim/pipeline.h"
#include "sim/relax.h"
#include "sim/sizes.h"
#include "sim/state.h"

namespace spherule::sim {

// A scene and its spheres as they are to begin, in id order.
struct Built {
    scene::Scene scene;
    State state;
};

// As the scene says. Refused where there is no memory for the states.
Result<Built> builtOf(scene::Scene scene);

// Everything a simulation needs to step: arrays, kernels, the spheres on the device. Made in pieces, beside a world
// that may go on stepping on the same device meanwhile. Used by the thread that owns the device.
class Preparation {
  public:
    using Build = std::function<Result<Built>(Progress&)>;

    // `copies`: memory that its maker has claimed for `built` or `build`, released with it.
    Preparation(compute::Device& device, Built built, memory::Claim copies = {});
    // `build` runs on a thread of its own, without the device; bad_alloc in it is an error as any other.
    Preparation(compute::Device& device, Build build, memory::Claim copies = {});
    // Cancels `build` and waits for its thread.
    ~Preparation();
    Preparation(const Preparation&) = delete;
    Preparation& operator=(const Preparation&) = delete;

    // Does one piece, about as long as a substep, or waits up to `patience` for the thread that builds. True once all
    // is done, and Simulation may take it; call it no more then, nor after an error.
    Result<bool> advance(std::chrono::milliseconds patience = std::chrono::milliseconds(0));
    // All pieces that are left.
    Result<void> finish();

    [[nodiscard]] Progress::Seen progress() const { return progress_.seen(); }

    // Spheres that began deep in each other were moved apart.
    struct Parted {
        double before = 0;  // largest overlap, in smaller radii
        double after = 0;
        std::uint32_t sweeps = 0;
    };

  private:
    friend class Simulation;
    enum class Stage : std::uint8_t { Building, Planning, Making, Uploading, Looking, Parting, Done };

    Result<void> doStage(std::chrono::milliseconds patience);
    Result<void> awaitBuilt(std::chrono::milliseconds patience);
    Result<void> makePlan();
    Result<void> makeNext();
    void upload();
    Result<void> look();
    Result<void> part();

    compute::Device& device_;
    memory::Claim copies_;
    memory::Claim claim_;  // of the simulation that it makes
    Progress progress_;
    std::uint64_t marks_ = 0;  // of the thread that builds, as last seen
    std::future<Result<Built>> building_;
    Stage stage_ = Stage::Building;
    Built built_;
    Radii radii_;
    std::unique_ptr<Pipeline> pipeline_;
    double tolerated_ = 0;  // overlap, in smaller radii
    std::unique_ptr<Relaxation> relaxation_;
    std::optional<Parted> parted_;
    std::jthread builder_;  // ends before what it uses
};

}  // namespace spherule::sim

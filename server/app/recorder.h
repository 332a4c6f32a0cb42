#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "app/record_options.h"
#include "compute/device.h"
#include "core/result.h"
#include "recording/writer.h"
#include "sim/simulation.h"
#include "sim/tier.h"
#include "spherule/v1/control.pb.h"

namespace spherule::app {

// Records a simulation that runs: nothing in the file depends on the clock. Used by the simulation thread.
class Recorder {
  public:
    // Begins with the present state. `device` is that of the simulation; both must outlive it. Refused where the
    // device has no room, and for what OutputFile cannot do.
    static Result<std::unique_ptr<Recorder>> create(const RecordOptions& options, compute::Device& device,
                                                    sim::Simulation& simulation);

    // After each step; `last`: none follows, and this one is recorded in any case.
    Result<void> stepped(bool last);
    Result<void> say(v1::Event::Kind kind, const std::string& text);
    // However the run has ended.
    Result<void> finish() { return writer_.finish(); }

    [[nodiscard]] const recording::Writer& writer() const { return writer_; }

  private:
    Recorder(const RecordOptions& options, compute::Device& device, sim::Simulation& simulation,
             recording::Writer writer)
        : options_(options), device_(device), simulation_(simulation), writer_(std::move(writer)) {}

    Result<void> begin();
    Result<void> writeSettings();
    Result<void> write(recording::Kind kind);
    Result<void> add(recording::Kind kind, const v1::ServerMessage& message);

    RecordOptions options_;
    compute::Device& device_;
    sim::Simulation& simulation_;
    recording::Writer writer_;
    std::unique_ptr<sim::TierTools> tools_;
    std::unique_ptr<sim::Tier> tier_;
    double quantum_ = 0;  // m
    std::uint64_t sequence_ = 0;
    double due_ = 0;        // frames that should have come by the next one's time
    double keyframe_ = 0;   // time of the last one, s simulated
    std::string settings_;  // as last written
};

}  // namespace spherule::app

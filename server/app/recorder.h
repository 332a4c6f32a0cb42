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

// Records a running simulation. The file does not depend on the clock. Used by the simulation thread.
class Recorder {
  public:
    // Begins with the present state. `device`: the device of the simulation. Both must outlive the recorder. Refused if
    // the device has no room. For errors of the file see OutputFile.
    static Result<std::unique_ptr<Recorder>> create(const RecordOptions& options, compute::Device& device,
                                                    sim::Simulation& simulation);

    // Call after each step. `last`: no step follows, so this one is always recorded.
    Result<void> stepped(bool last);
    Result<void> say(v1::Event::Kind kind, const std::string& text);
    // Call at the end, even if the run has failed.
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
    double due_ = 0;        // number of the next frame, which is due at due_ / rate
    double keyframe_ = 0;   // time of the last keyframe (s simulated)
    std::string settings_;  // serialized, as written last
};

}  // namespace spherule::app

#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "compute/device.h"
#include "core/result.h"
#include "encode/frame_encoder.h"
#include "recording/options.h"
#include "recording/writer.h"
#include "sim/simulation.h"
#include "spherule/v1/control.pb.h"

namespace spherule::host {

// Records a running simulation. The file does not depend on the clock, unless it carries a log. Used by the thread that
// owns the device.
class RunRecorder {
  public:
    // Begins with the present state. `device`: the device of the simulation. Both must outlive the recorder. `plan`:
    // what the run follows from beside its options and the simulation, such as its duration and its script. Refused if
    // the device has no room. For errors of the file see OutputFile.
    static Result<std::unique_ptr<RunRecorder>> create(const recording::Options& options, compute::Device& device,
                                                       sim::Simulation& simulation, std::string_view plan);

    // Call after each step. `last`: no step follows, so this one is always recorded. So is the first step with
    // new spheres. New scene facts come before a frame of other spheres; an empty world has no frames.
    Result<void> stepped(bool last);
    Result<void> addEvent(v1::Event::Kind kind, const std::string& text);
    // Where the bytes of a command log go. Any one thread may use it. The recorder must outlive it.
    std::unique_ptr<recording::ByteSink> logSink();
    // Call at the end, even if the run has failed. No log may be under way.
    Result<void> finish() { return writer_.finish(); }

    [[nodiscard]] const recording::Writer& writer() const { return writer_; }

  private:
    RunRecorder(const recording::Options& options, compute::Device& device, sim::Simulation& simulation,
                recording::Writer writer)
        : options_(options), device_(device), simulation_(simulation), writer_(std::move(writer)) {}

    // The encoder must not outlive the context.
    struct Encoding {
        std::unique_ptr<encode::EncoderContext> context;
        std::unique_ptr<encode::FrameEncoder> encoder;
    };
    static Result<Encoding> makeEncoding(const recording::Options& options, compute::Device& device,
                                         sim::Simulation& simulation);

    Result<void> beginEpoch();
    Result<void> writeSettings();
    Result<void> write(recording::Kind kind);
    Result<void> add(recording::Kind kind, const v1::ServerMessage& message);

    recording::Options options_;
    compute::Device& device_;
    sim::Simulation& simulation_;
    std::mutex mutex_;  // of writer_, while a log is under way
    recording::Writer writer_;
    Encoding encoding_;
    std::uint32_t epoch_ = 0;
    std::uint32_t generation_ = 0;
    std::uint64_t population_ = 0;  // its version
    std::uint64_t groups_ = 0;      // their version
    std::uint64_t sequence_ = 0;
    double due_ = 0;        // number of the next frame, which is due at due_ / rate
    double keyframe_ = 0;   // time of the last keyframe (s simulated)
    std::string settings_;  // serialized, as written last
};

}  // namespace spherule::host

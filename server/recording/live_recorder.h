#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "codec/rendition.h"
#include "core/result.h"
#include "recording/background_writer.h"
#include "recording/options.h"
#include "recording/output_file.h"

namespace spherule::recording {

// Records the stream of a viewer: subscribes to a rendition as viewers do, and writes the messages for viewers. Used by
// the simulation thread, which never waits for the disk.
class LiveRecorder {
  public:
    using Clock = std::chrono::steady_clock;

    // `source`: the program and device that made the recording, its first record.
    LiveRecorder(LiveOptions options, v1::Welcome source);

    // Starts a recording in the file of the options, if they name one.
    Result<void> startFromOptions();
    // Starts a recording in a new file of the options' folder. Refused while it records, without a folder, and if the
    // folder is full.
    Result<void> start();
    // Ends the recording. One that has a log ends when the log has been closed.
    Result<void> stop();

    // Returns true once for each recording that should have a command log.
    bool wantsLog() { return std::exchange(wantsLog_, false); }
    // Where the bytes of the log go. May outlive the recorder. The recording does not end before it is closed or
    // destroyed.
    std::unique_ptr<ByteSink> logSink();

    // The messages for viewers, when they are sent. broadcast() records only events.
    void retain(codec::SharedMessage message);
    void broadcast(const codec::SharedMessage& message);
    void setOrder(codec::SharedMessage message);
    void publish(const codec::EncodedFrame& encoded);

    // Adds the subscription of the recording, if there is one.
    void subscribe(std::vector<codec::Subscription>& subscriptions, Clock::time_point now) const;
    // Returns the state of the recording when it has changed, and once a second while it records; else nullopt.
    std::optional<v1::Recording> changedState(Clock::time_point now);
    // Ends the recording and waits for the disk. Returns its last state; nullopt if there is no recording.
    std::optional<v1::Recording> finish();
    // Returns true if the last recording ended in order, but without a frame.
    [[nodiscard]] bool endedEmpty() const { return endedEmpty_; }
    [[nodiscard]] const codec::Rendition& rendition() const { return rendition_; }
    [[nodiscard]] bool startsAtOnce() const { return !options_.path.empty(); }
    [[nodiscard]] bool canRecord() const { return !options_.folder.empty() || !options_.path.empty(); }
    // The files that start() has begun in the folder of the options.
    [[nodiscard]] const std::vector<std::string>& files() const { return files_; }
    [[nodiscard]] std::uint64_t framesLost() const { return framesLost_; }

  private:
    Result<void> start(const std::string& path, bool replace, std::uint64_t mostBytes);
    [[nodiscard]] Result<std::uint64_t> roomInFolder() const;
    [[nodiscard]] Result<std::string> newPath() const;
    void add(Kind kind, const codec::SharedMessage& message);
    void timeOf(const v1::Frame& frame);
    [[nodiscard]] bool standsStill(const v1::Frame& frame) const;
    void leaveOut(const v1::Frame& frame);

    LiveOptions options_;
    codec::Rendition rendition_;
    codec::SharedMessage source_;
    codec::SharedMessage scene_, order_, settings_;  // the latest, for a recording that starts
    std::shared_ptr<BackgroundWriter> writer_;
    v1::Recording state_;
    std::vector<std::string> files_;
    std::optional<std::uint32_t> number_;  // of the newest frame of the chain; nullopt: a keyframe is needed
    Clock::time_point keyframe_{};
    bool moved_ = false;    // since the last keyframe
    bool refused_ = false;  // the chain is lost because the disk is too slow
    // Time in the recording. It never goes back, unlike the time of a simulation that is reset.
    double begin_ = 0, time_ = 0, offset_ = 0;  // s
    double simTime_ = 0;                        // s, simulated time of the newest frame
    bool timed_ = false;
    bool wantsLog_ = false;
    bool stopping_ = false;  // stop() was called, and the writer has not ended
    bool endedEmpty_ = false;
    bool waits_ = false;     // for the world to advance
    bool reported_ = false;  // the present state has been returned by changedState()
    Clock::time_point reportedAt_{};
    std::uint64_t framesLost_ = 0;
};

}  // namespace spherule::recording

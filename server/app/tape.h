#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/record_options.h"
#include "codec/rendition.h"
#include "core/result.h"
#include "recording/background_writer.h"

namespace spherule::app {

// Records what a viewer is sent: it subscribes to a rendition as viewers do, and what it is told of, it writes. Used by
// the simulation thread, which never waits for the disk.
class Tape {
  public:
    using Clock = std::chrono::steady_clock;

    // `source`: what made the recording, its first record.
    Tape(TapeOptions options, v1::Welcome source);

    // In the file of the options, where they name one.
    Result<void> startFromOptions();
    // In a new file of the options' folder. Refused while it records, without a folder, and where that is full.
    Result<void> start();
    Result<void> stop();

    // What viewers are told, at the same time as they are: of what is said, events are recorded.
    void retain(codec::SharedMessage message);
    void say(const codec::SharedMessage& message);
    void order(codec::SharedMessage message);
    void frame(const codec::EncodedFrame& encoded);

    // Adds its own, while it records.
    void subscribe(std::vector<codec::Subscription>& subscriptions, Clock::time_point now) const;
    // How it goes, where that is not what it last said; while it records, once a second.
    std::optional<v1::Recording> news(Clock::time_point now);
    // Ends the recording, if there is one, waits for the disk, and tells how it is.
    std::optional<v1::Recording> finish();
    [[nodiscard]] const codec::Rendition& rendition() const { return rendition_; }
    [[nodiscard]] bool beginsByItself() const { return !options_.path.empty(); }
    [[nodiscard]] bool canRecord() const { return !options_.folder.empty() || !options_.path.empty(); }
    [[nodiscard]] std::uint64_t framesLost() const { return framesLost_; }

  private:
    Result<void> start(const std::string& path, bool replace, std::uint64_t mostBytes);
    [[nodiscard]] Result<std::uint64_t> roomInFolder() const;
    [[nodiscard]] Result<std::string> newPath() const;
    void add(recording::Kind kind, const codec::SharedMessage& message);
    void timeOf(const v1::Frame& frame);
    [[nodiscard]] bool standsStill(const v1::Frame& frame) const;
    void leaveOut(const v1::Frame& frame);

    TapeOptions options_;
    codec::Rendition rendition_;
    codec::SharedMessage source_;
    codec::SharedMessage scene_, order_, settings_;  // the latest, for a recording that begins
    std::unique_ptr<recording::BackgroundWriter> writer_;
    v1::Recording state_;
    std::optional<std::uint32_t> number_;  // of the newest frame of the chain; nothing: a keyframe is wanted
    Clock::time_point keyframe_{};
    bool moved_ = false;    // since that
    bool refused_ = false;  // the chain is lost because the disk is too slow
    // Time in the recording: never goes back, though that of the simulation does when it is reset.
    double begin_ = 0, time_ = 0, offset_ = 0;  // s
    double simTime_ = 0;                        // s, of the simulation in the newest frame
    bool timed_ = false;
    bool waits_ = false;  // for the world to go on
    bool told_ = false;   // of the state
    Clock::time_point toldAt_{};
    std::uint64_t framesLost_ = 0;
};

}  // namespace spherule::app

#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "recording/recording.h"
#include "sim/commands.h"
#include "spherule/v1/control.pb.h"

namespace spherule::host {

// Plays a recording. Has everything that commands can change: the position, the speed and the pause. Used by one
// thread.
class Player {
  public:
    using Clock = std::chrono::steady_clock;

    // `again`: after the end, it continues at the beginning.
    Player(recording::Recording recording, std::string name, bool again, Clock::time_point now);

    // Carries out a command, or refuses it and changes nothing. A seek is done by the next advance().
    Result<sim::Applied> apply(const v1::Command& command, Clock::time_point now);

    struct Moved {
        bool shown = false;                            // another frame is shown
        std::vector<v1::ServerMessage> skippedEvents;  // events of the skipped part
        std::vector<std::string> damage;               // errors of the parts that were skipped
    };
    // Moves to the frame that is due at `now`.
    Moved advance(Clock::time_point now);
    // When to call advance() again; nullopt while it waits for a command.
    [[nodiscard]] std::optional<Clock::time_point> due() const;

    [[nodiscard]] const recording::Recording& recording() const { return recording_; }
    [[nodiscard]] bool paused() const { return paused_; }
    [[nodiscard]] double speed() const { return speed_; }  // recorded seconds per second
    [[nodiscard]] v1::Timeline timeline() const;
    [[nodiscard]] v1::Settings settings() const;

  private:
    [[nodiscard]] bool goesOn() const { return !paused_ || steps_ > 0; }
    [[nodiscard]] double placeBy(Clock::time_point now) const;
    void resume(Clock::time_point now);
    void goOnFrom(double place, Clock::time_point now);
    void seek(double time);
    void goTo(double time, Moved& moved);
    Result<void> setSpeed(const v1::Set& set, Clock::time_point now);
    Result<void> step(std::uint32_t count, Clock::time_point now);
    void skip(const Error& error, double from, Moved& moved);
    void findNext();

    recording::Recording recording_;
    std::string name_;
    bool again_;
    bool paused_ = false;
    std::uint32_t steps_ = 0;  // frames to play before it pauses; 0: no limit
    double speed_ = 1;
    std::optional<double> wanted_;  // position to move to next (s of the recording)
    double place_ = 0;              // position at `since_` (s of the recording)
    Clock::time_point since_;
    v1::Settings settings_;       // as recorded, of the frame shown
    std::optional<double> next_;  // time of the next frame (s); nullopt at the end
};

}  // namespace spherule::host

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

namespace spherule::app {

// Where a recording is, and how it goes on: all that commands change of it. One thread.
class Player {
  public:
    using Clock = std::chrono::steady_clock;

    // `again`: from the end it goes on at the beginning.
    Player(recording::Recording recording, std::string name, bool again, Clock::time_point now);

    // Carries a command out, or refuses it and changes nothing. The next advance() does a seek.
    Result<sim::Applied> apply(const v1::Command& command, Clock::time_point now);

    struct Moved {
        bool shown = false;                            // another moment is
        std::vector<v1::ServerMessage> skippedEvents;  // events on the way
        std::vector<std::string> damage;               // what could not be played, and was skipped
    };
    // To where it is by now.
    Moved advance(Clock::time_point now);
    // When to call that again; nothing while it waits for a command.
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
    std::uint32_t steps_ = 0;  // frames to go before it pauses; 0: it does not
    double speed_ = 1;
    std::optional<double> wanted_;  // s of the recording, by a command
    double place_ = 0;              // s of the recording, at `since_`
    Clock::time_point since_;
    v1::Settings settings_;       // recorded, of what is shown
    std::optional<double> next_;  // time of the frame after the present one; nothing at the end
};

}  // namespace spherule::app

#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "app/chains.h"
#include "app/player.h"
#include "app/show.h"
#include "app/state_rate.h"
#include "compute/device.h"

namespace spherule::app {

// Shows a recording: decodes it, and encodes its states in the renditions that viewers request. Waits for a command or
// for the next frame.
class PlayLoop : public Show {
  public:
    PlayLoop(std::unique_ptr<compute::Device> device, Player player, const Stage& stage);

    // Runs until stopped, or until an error.
    Result<void> run(const std::stop_token& stop) override;

  private:
    void serve(const Request& request);
    Result<void> advance(Chains::Clock::time_point now);
    Result<void> show();
    void describe();
    void sendSettings();
    void say(v1::Event::Kind kind, const std::string& text);
    void produce(Chains::Clock::time_point now);
    void publish(const codec::EncodedFrame& encoded);
    v1::Status status(Chains::Clock::time_point now);
    void report(Chains::Clock::time_point now);
    [[nodiscard]] Chains::Clock::duration patience(Chains::Clock::time_point now) const;

    std::unique_ptr<compute::Device> device_;
    Player player_;
    Requests& requests_;
    Live& live_;
    Outlets outlets_;
    Chains chains_;
    StateRate states_;
    sim::State state_;                            // positions of the current frame, by id
    std::unique_ptr<compute::Buffer> positions_;  // the same on the device
    double time_ = 0;                             // of the current frame (s)
    std::uint64_t step_ = 0;                      // of the current frame
    std::uint64_t sceneOffset_ = 0;               // offset of the scene facts in the recording (bytes)
    std::uint32_t epoch_ = 0;                     // epoch that was sent to viewers
    std::uint64_t version_ = 0;
    double smallest_ = 0;   // smallest radius (m)
    std::string settings_;  // serialized, as sent last
    Chains::Clock::time_point nextReport_{};
};

}  // namespace spherule::app

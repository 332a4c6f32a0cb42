#pragma once

#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>

#include "compute/device.h"
#include "encode/stream_encoder.h"
#include "host/frame_producer.h"
#include "host/player.h"
#include "host/rate_meter.h"

namespace spherule::host {

// Shows a recording: decodes it, and encodes its states in the renditions that viewers request. Waits for a command or
// for the next frame.
class PlaybackProducer : public FrameProducer {
  public:
    PlaybackProducer(std::unique_ptr<compute::Device> device, Player player, const ProducerIo& io);

    // Runs until stopped, or until an error.
    Result<void> run(const std::stop_token& stop) override;

  private:
    void serve(const Request& request);
    Result<void> advance(encode::StreamEncoder::Clock::time_point now);
    Result<void> show();
    void describe();
    void sendSettings();
    void notify(v1::Event::Kind kind, const std::string& text);
    void produce(encode::StreamEncoder::Clock::time_point now);
    void publish(const codec::EncodedFrame& encoded);
    v1::Status status(encode::StreamEncoder::Clock::time_point now);
    void report(encode::StreamEncoder::Clock::time_point now);
    [[nodiscard]] encode::StreamEncoder::Clock::duration waitTime(encode::StreamEncoder::Clock::time_point now) const;

    std::unique_ptr<compute::Device> device_;
    Player player_;
    Requests& requests_;
    StatusBoard& board_;
    net::Publisher& publisher_;
    std::uint64_t framesMade_ = 0;
    encode::StreamEncoder encoder_;
    RateMeter frameRate_;
    codec::PerColumn<std::vector<glm::vec4>> values_;             // of the current frame, by id; w = 0
    codec::PerColumn<std::unique_ptr<compute::Buffer>> buffers_;  // the same on the device
    double time_ = 0;                                             // of the current frame (s)
    std::uint64_t step_ = 0;                                      // of the current frame
    std::vector<v1::Pose> poses_;                                 // of the current frame
    std::uint64_t sceneOffset_ = 0;                               // offset of the scene facts in the recording (bytes)
    std::uint32_t epoch_ = 0;                                     // epoch that was sent to viewers
    std::uint64_t version_ = 0;
    double smallest_ = 0;   // smallest radius (m)
    std::string settings_;  // serialized, as sent last
    encode::StreamEncoder::Clock::time_point nextReport_{};
};

}  // namespace spherule::host

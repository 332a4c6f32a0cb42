#pragma once

#include <functional>
#include <memory>
#include <stop_token>

#include "core/result.h"
#include "host/requests.h"
#include "host/scene_saver.h"
#include "host/status_board.h"
#include "net/publisher.h"

namespace spherule::host {

// Inputs and outputs of a producer: requests to it, its status, the sessions, and the scenes to save. All outlive the
// producer.
struct ProducerIo {
    Requests& requests;
    StatusBoard& board;
    net::Publisher& publisher;
    SceneSaver& saver;
};

// Produces the frames of a simulation or of a recording. Created, used and destroyed by one thread.
class FrameProducer {
  public:
    FrameProducer() = default;
    virtual ~FrameProducer() = default;
    FrameProducer(const FrameProducer&) = delete;
    FrameProducer& operator=(const FrameProducer&) = delete;

    // Runs until stopped, or until an error.
    virtual Result<void> run(const std::stop_token& stop) = 0;
};

// Opens the device and the scene or file, and fills in their entries on the board. Runs on the simulation thread.
using ProducerFactory = std::function<Result<std::unique_ptr<FrameProducer>>(const ProducerIo& io)>;

}  // namespace spherule::host

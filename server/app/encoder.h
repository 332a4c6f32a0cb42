#pragma once

#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

#include "core/latest_slot.h"
#include "frame/message.h"
#include "spherule/v1/frame.pb.h"

namespace spherule::app {

// A thread that turns packed states into messages, off the simulation's way. A state that comes while one is being
// encoded replaces any that waits.
class Encoder {
  public:
    struct Packed {
        v1::Frame head;  // all but the states
        std::vector<std::byte> bytes;
    };

    explicit Encoder(std::function<void(frame::SharedMessage)> publish);
    ~Encoder();
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    void put(Packed state) { slot_.put(std::move(state)); }

  private:
    LatestSlot<Packed> slot_;
    std::thread thread_;
};

}  // namespace spherule::app

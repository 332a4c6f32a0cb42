#pragma once

#include <memory>
#include <thread>
#include <vector>

#include "viewer.h"

namespace spherule::load {

struct Composition {
    std::uint32_t viewers = 1;  // total
    std::uint32_t stalled = 0;
    std::uint32_t slow = 0;  // half of them read slowly, half acknowledge late
    std::uint32_t reconnecting = 0;
    std::uint32_t decode = 0;  // healthy viewers that decode frames
};

// All viewers, on a few threads. They connect over one second, to spread the load.
class Crowd {
  public:
    Crowd(const Wish& wish, const Composition& composition, unsigned threads);
    ~Crowd();  // disconnects without a close frame
    Crowd(const Crowd&) = delete;
    Crowd& operator=(const Crowd&) = delete;

    void start();
    // Disconnects all viewers; call once.
    Tallies stop();

  private:
    struct Share {
        boost::asio::io_context io{1};
        std::vector<std::unique_ptr<Viewer>> viewers;
        std::jthread thread;
    };

    std::vector<std::unique_ptr<Share>> shares_;
    std::uint32_t size_;
};

}  // namespace spherule::load

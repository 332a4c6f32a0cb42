#pragma once

#include <memory>
#include <thread>
#include <vector>

#include "viewer.h"

namespace spherule::load {

struct Composition {
    std::uint32_t viewers = 1;  // all of them
    std::uint32_t stalled = 0;
    std::uint32_t slow = 0;  // every other one reads slowly, the rest acknowledge late
    std::uint32_t reconnecting = 0;
    std::uint32_t decode = 0;  // of the healthy ones
};

// All viewers, on a few threads of their own. They join over a second, so that the server is not asked for all at once.
class Crowd {
  public:
    Crowd(const Wish& wish, const Composition& composition, unsigned threads);
    ~Crowd();  // leaves without a word
    Crowd(const Crowd&) = delete;
    Crowd& operator=(const Crowd&) = delete;

    void start();
    // Ends it; call once.
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

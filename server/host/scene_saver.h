#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <mutex>

#include "net/server.h"

namespace spherule::sim {
class Simulation;
}

namespace spherule::host {

// Makes scene files of the present state, for clients that ask for them: one at a time, and at most one a second. The
// simulation thread only copies the state; a thread of its own and the io thread do the rest.
class SceneSaver {
  public:
    using Made = std::function<void(std::shared_ptr<net::Document>, net::HttpAnswer refusal)>;
    using Clock = std::chrono::steady_clock;

    // A simulation begins or ends. Until then, and after that, there is nothing to save.
    void open();
    void close();
    // Any thread.
    void ask(Made made);
    // Simulation thread: answers a client that has asked. Call it often.
    void serve(sim::Simulation& simulation);

  private:
    void refuse(const Made& made, int status, const std::string& text);
    // Refuses what is under way, so that others can ask.
    void fail(const Made& made, const std::string& text);

    std::mutex mutex_;
    bool open_ = false;
    Made asked_;                             // empty: nobody asks
    std::weak_ptr<net::Document> document_;  // under way
    std::future<void> making_;               // used by the simulation thread
    bool busy_ = false;                      // from the question until the document is made
    Clock::time_point next_{};               // earliest time of the next one
};

}  // namespace spherule::host

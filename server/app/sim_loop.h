#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <stop_token>

#include "app/chains.h"
#include "app/live.h"
#include "app/observer.h"
#include "app/tuner.h"
#include "app/world.h"
#include "core/bounded_queue.h"
#include "frame/message.h"

namespace spherule::app {

struct Request {
    std::uint64_t session = 0;
    v1::Command command;
};

// Where the simulation's results go; called on the simulation thread.
struct Outlets {
    std::function<void(frame::SharedMessage)> scene;
    std::function<void(frame::SharedMessage)> settings;
    std::function<void(frame::SharedMessage)> dial;
    std::function<void(frame::SharedMessage)> everybody;  // events, diagnostics
    std::function<void(frame::SharedMessage)> order;
    std::function<void(const frame::Link&)> frame;
    std::function<void(std::uint64_t session, v1::CommandResult)> reply;
    std::function<std::uint32_t()> viewers;
    std::function<std::vector<frame::Demand>()> demands;
};

// What the simulation thread does: commands, steps, states. It waits for a command, for the next step or for the device
// to end one, never for the network or for the copy of a state.
class SimLoop {
  public:
    SimLoop(World& world, BoundedQueue<Request>& requests, Live& live, quality::Table table, Outlets outlets);

    // Until stopped or the device is lost.
    Result<void> run(const std::stop_token& stop);

  private:
    void serve(const Request& request);
    void announce();
    Result<void> step();
    Result<void> tune(double wallMs);
    void say(v1::Event::Kind kind, const std::string& text);
    void stopAtNonFinite();
    void produce(Pacer::Clock::time_point now);
    v1::Frame head(Pacer::Clock::time_point now);
    void publish(const frame::Link& link);
    void report();
    void look(const std::vector<double>& passSeconds);
    void sendDial();
    [[nodiscard]] v1::Status status(Pacer::Clock::time_point now);
    [[nodiscard]] Pacer::Clock::duration patience(Pacer::Clock::time_point now) const;

    World& world_;
    BoundedQueue<Request>& requests_;
    Live& live_;
    Outlets outlets_;
    Chains chains_;
    std::deque<Pacer::Clock::time_point> produced_;
    Pacer::Clock::time_point nextReport_{};
    Tuner tuner_;
    Observer observer_;
    std::optional<v1::Diagnostics> seen_;  // of the last report while somebody watched
    std::uint64_t version_ = 0;            // of the world, as far as viewers can see
    std::uint64_t shown_ = 0;              // the version of the newest frame
    std::uint32_t epoch_ = 0;
    std::string settings_;  // as last sent
    bool watched_ = false;
};

}  // namespace spherule::app

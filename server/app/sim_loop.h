#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "app/chains.h"
#include "app/dispatch.h"
#include "app/observer.h"
#include "app/show.h"
#include "app/state_rate.h"
#include "app/tape.h"
#include "app/tuner.h"
#include "app/world.h"

namespace spherule::app {

// The simulation thread: carries out commands, steps the world and produces states. It waits for a command, for the
// next step or for the device to end one. It never waits for the network, for the disk or for the copy of a state.
class SimLoop : public Show, private HostCommands {
  public:
    SimLoop(std::unique_ptr<World> world, const Stage& stage, quality::Table table, TapeOptions recordings);

    // Runs until stopped, until the device is lost, or until the recording of the options fails.
    Result<void> run(const std::stop_token& stop) override;

  private:
    // Runs until stopped, or until the device is lost.
    Result<void> simulate(const std::stop_token& stop);
    void serveWaiting();
    void serve(Request request);
    void carryOut(Request request);
    Request takeHeld();
    std::optional<Result<sim::Applied>> apply(const v1::Command& command);
    void finish(const Request& request, const Result<sim::Applied>& applied);
    void refuse(const Request& request, const std::string& reason);
    void refuseChange(const std::string& reason);
    void refuseSteps(std::string_view reason);
    void refuseHeldSteps();
    Result<void> cancel() override;
    void answerQueries();
    bool goOn(Result<void>& done);
    Result<void> stepFor(Pacer::Clock::time_point now);
    void advanceChange(Pacer::Clock::duration slice);
    void tellOfChange();
    [[nodiscard]] std::string changeInWords() const;
    [[nodiscard]] std::string slowness() const;
    void announce();
    void retain(v1::ServerMessage message);
    void broadcast(v1::ServerMessage message);
    void countStep();
    Result<void> tune(double wallMs);
    void say(v1::Event::Kind kind, const std::string& text);
    void tellNotices();
    void stopAtNonFinite();
    void lookAtStill();
    Result<void> roomForTape();
    Result<void> startRecording() override;
    Result<void> stopRecording() override { return tape_.stop(); }
    void produce(Pacer::Clock::time_point now);
    Scenery scenery(Pacer::Clock::time_point now);
    v1::Frame head(Pacer::Clock::time_point now);
    void publish(const codec::EncodedFrame& encoded);
    Result<void> report();
    void tellOfTape();
    Result<void> finishTape();
    void look(const std::vector<double>& passSeconds);
    void sendDial();
    [[nodiscard]] v1::Status status(Pacer::Clock::time_point now);
    [[nodiscard]] Pacer::Clock::duration patience(Pacer::Clock::time_point now) const;

    std::unique_ptr<World> owned_;
    World& world_;
    Requests& requests_;
    Live& live_;
    Outlets outlets_;
    Chains chains_;
    Tape tape_;
    StateRate states_;
    Pacer::Clock::time_point nextReport_{};
    Tuner tuner_;
    Observer observer_;
    Result<sim::Applied> answer_;                       // to queries; reused while nothing newer is needed
    std::optional<Pacer::Clock::time_point> answered_;  // time of answer_; nullopt: a newer one is needed
    std::optional<v1::Diagnostics> seen_;               // diagnostics of the last report; nullopt if nobody watched
    std::uint64_t version_ = 0;                         // version of the world, as viewers see it
    std::uint32_t epoch_ = 0;
    std::string settings_;  // serialized, as sent last
    bool watched_ = false;
    std::vector<double> passSeconds_;  // device time (s) since the last look(), by sim::Pass
    bool missed_ = false;              // a report was due in the middle of a step

    struct Asked {
        Request request;
        Pacer::Clock::time_point since;
    };
    struct Steps {
        Asked asked;
        std::uint32_t left = 0;
    };
    std::optional<Asked> change_;  // command whose change is under way
    std::deque<Asked> held_;       // commands that wait for the change to end
    std::size_t heldBytes_ = 0;    // memory of these commands
    std::deque<Steps> steps_;      // step commands with steps left, in order
    double stepMs_ = 0;            // wall time of the step under way (ms)
    bool toldOfChange_ = false;
    Pacer::Clock::time_point nextTold_{};
};

}  // namespace spherule::app

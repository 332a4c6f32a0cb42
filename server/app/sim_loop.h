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

// What the simulation thread does: commands, steps, states. It waits for a command, for the next step or for the device
// to end one, never for the network, for the disk or for the copy of a state.
class SimLoop : public Show, private HostCommands {
  public:
    SimLoop(std::unique_ptr<World> world, const Stage& stage, quality::Table table, TapeOptions recordings);

    // Until stopped, the device is lost, or the recording that was asked for cannot be made.
    Result<void> run(const std::stop_token& stop) override;

  private:
    // Until stopped, or the device is lost.
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
    Result<sim::Applied> answer_;                       // to queries; nothing newer is needed before
    std::optional<Pacer::Clock::time_point> answered_;  // when it was made, the world as it was then
    std::optional<v1::Diagnostics> seen_;               // of the last report while somebody watched
    std::uint64_t version_ = 0;                         // of the world, as far as viewers can see
    std::uint32_t epoch_ = 0;
    std::string settings_;  // as last sent
    bool watched_ = false;
    std::vector<double> passSeconds_;  // by sim::Pass, since somebody looked
    bool missed_ = false;              // a report came due in the middle of a step

    struct Asked {
        Request request;
        Pacer::Clock::time_point since;
    };
    struct Steps {
        Asked asked;
        std::uint32_t left = 0;
    };
    std::optional<Asked> change_;  // whose change is under way
    std::deque<Asked> held_;       // commands that wait for it to end
    std::size_t heldBytes_ = 0;    // of these
    std::deque<Steps> steps_;      // commands whose steps are not all done, in order
    double stepMs_ = 0;            // wall time of the step under way
    bool toldOfChange_ = false;
    Pacer::Clock::time_point nextTold_{};
};

}  // namespace spherule::app

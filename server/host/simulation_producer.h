#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "checkpoint/keeper.h"
#include "diagnostics/substep_controller.h"
#include "host/command_executor.h"
#include "host/diagnostics_sampler.h"
#include "host/frame_producer.h"
#include "host/rate_meter.h"
#include "host/scene_watch.h"
#include "host/simulation_host.h"
#include "host/state_streams.h"
#include "recording/live_recorder.h"

namespace spherule::host {

// Produces the frames of a simulation: carries out commands, steps the simulation and encodes its states. It waits for
// a command, for the next step or for the device to end one. It never waits for the network or for the disk. It stands
// still while the state for a checkpoint is copied.
class SimulationProducer : public FrameProducer, private CommandExecutor::Effects {
  public:
    // `watch`: of the file of the scene, which is loaded again when it changes; null: none. `keeper`: writes the
    // checkpoints and the command log; null: there are none.
    SimulationProducer(std::unique_ptr<SimulationHost> host, const ProducerIo& io, diagnostics::Table table,
                       recording::LiveOptions recordings, std::unique_ptr<SceneWatch> watch = nullptr,
                       std::unique_ptr<checkpoint::Keeper> keeper = nullptr);

    // Runs until stopped, until the device is lost, or until the recording of the options fails.
    Result<void> run(const std::stop_token& stop) override;

  private:
    using Clock = StepScheduler::Clock;

    // Runs until stopped, or until the device is lost.
    Result<void> simulate(const std::stop_token& stop);
    Result<void> resume();
    void carriedOut(const checkpoint::Keeper::Place& at, const Request& request) override;
    Result<void> checkCheckpoints() override;
    [[nodiscard]] v1::StateHead stateHead();
    [[nodiscard]] bool wantsCheckpoint(Clock::time_point now) const;
    void keepState(Clock::time_point now);
    void saveState(Clock::time_point now);
    void reportCheckpoints();
    void finishState();
    bool advance(Result<void>& done);
    Result<void> advanceStep(Clock::time_point now);
    void reportChange();
    [[nodiscard]] std::string slowness() const;
    void worldChanged() override;
    void publishChanges() override;
    void reloaded(const Result<sim::Applied>& done) override;
    void reloadWhenSaved();
    void retain(v1::ServerMessage message);
    void broadcast(v1::ServerMessage message);
    Result<void> tune(double wallMs);
    void notify(v1::Event::Kind kind, const std::string& text);
    void reportNotices();
    void stopAtNonFinite();
    void reportWhenStopped();
    Result<void> reserveEncoder();
    Result<void> startRecording() override;
    Result<void> stopRecording() override;
    void beginLogInRecording();
    void produce(Clock::time_point now);
    StateStreams::Moment moment(Clock::time_point now);
    v1::Frame head(Clock::time_point now);
    Result<void> report();
    void reportRecording();
    Result<void> finishRecording();
    void sampleDiagnostics(const std::vector<double>& passSeconds);
    void sendDial();
    void sendParts();
    [[nodiscard]] v1::Status status(Clock::time_point now);
    [[nodiscard]] Clock::duration waitTime(Clock::time_point now) const;

    std::unique_ptr<SimulationHost> owned_;
    SimulationHost& host_;
    StatusBoard& board_;
    net::Publisher& publisher_;
    SceneSaver& saver_;
    std::unique_ptr<checkpoint::Keeper> keeper_;
    static constexpr std::uint64_t notSaved = ~std::uint64_t{0};
    std::uint64_t savedVersion_ = notSaved;  // of the world in the last checkpoint
    Clock::time_point savedAt_{};
    std::unique_ptr<SceneWatch> watch_;
    std::string saved_;  // the file for which the watched scene was loaded last
    recording::LiveRecorder recorder_;
    StateStreams streams_;
    RateMeter frameRate_;
    Clock::time_point nextReport_{};
    diagnostics::SubstepController substepController_;
    DiagnosticsSampler sampler_;
    CommandExecutor commands_;
    std::optional<v1::Diagnostics> diagnostics_;  // diagnostics of the last report; nullopt if nobody watched
    std::uint64_t version_ = 0;                   // version of the world, as viewers see it
    std::uint32_t world_ = 0;                     // the host's epoch
    std::uint64_t population_ = 0;                // its version at the end of the last step
    std::string settings_;                        // serialized, as sent last
    // The state of the simulation of which viewers know the parts.
    struct Parts {
        std::uint32_t epoch = 0;
        std::uint64_t version = 0;
        bool operator==(const Parts&) const = default;
    };
    std::optional<Parts> parts_;
    std::string partsBytes_;  // serialized, as sent last
    bool watched_ = false;
    bool timed_ = false;               // passes are timed
    std::vector<double> passSeconds_;  // device time (s) since the last sampleDiagnostics(), by sim::Pass
    bool reportMissed_ = false;        // a report was due in the middle of a step
    double stepMs_ = 0;                // wall time of the step under way (ms)
    bool changeReported_ = false;
    Clock::time_point nextChangeReport_{};
};

}  // namespace spherule::host

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <future>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "checkpoint/keeper.h"
#include "core/memory.h"
#include "core/result.h"
#include "host/dispatch.h"
#include "host/requests.h"
#include "host/simulation_host.h"
#include "net/publisher.h"

namespace spherule::host {

// Carries out the commands of sessions on a simulation, and answers each of them once. A command that begins a change
// is answered at the end of the change, and a step command after its last step. Commands that need the end of a change
// wait for it, in order. Used by the simulation thread.
class CommandExecutor : private ProducerCommands {
  public:
    using Clock = SimulationHost::Clock;

    // Effects of commands beyond the simulation and the answers.
    class Effects {
      public:
        Effects() = default;
        virtual ~Effects() = default;
        Effects(const Effects&) = delete;
        Effects& operator=(const Effects&) = delete;

        virtual Result<void> startRecording() = 0;
        virtual Result<void> stopRecording() = 0;
        virtual void worldChanged() = 0;    // a command has changed the world (changes_world in control.proto)
        virtual void publishChanges() = 0;  // scene facts, settings or the dial may have changed
        virtual void reloaded(const Result<sim::Applied>& done) = 0;  // reload() has ended
        // A command has changed the simulation, or will in the steps that follow. `at`: the place before it.
        virtual void carriedOut(const checkpoint::Keeper::Place& at, const Request& request) = 0;
        virtual Result<void> checkCheckpoints() = 0;  // refused if none can be written
    };

    // All must outlive the executor.
    CommandExecutor(SimulationHost& host, Requests& requests, net::Publisher& publisher, Effects& effects);

    // Carries out waiting commands for at most about 20 ms. Refuses those that have waited too long for a change.
    void serveWaiting();
    // Waits up to `timeout` for a command, and carries it out.
    void serveNext(Clock::duration timeout);
    // Answers the waiting queries and inspections. Inspections take a small part of the time. Queries without a hash
    // get the same answer. Every answer includes every applied command and every completed step command. A hash takes a
    // thread of its own: the world goes on, and the answer comes in a later call.
    void answerQueries();
    // When to call answerQueries() again for the inspections that wait; nullopt if there are none.
    [[nodiscard]] std::optional<Clock::time_point> due() const;
    // The next query needs a new answer. Call after each change of the state that is not a step.
    void discardAnswer() { answered_.reset(); }

    // Does a part of the change under way, for about `slice`, and answers its command at the end.
    void advanceChange(Clock::duration slice);
    // Counts a step for the oldest step command, and answers the command after its last step.
    void countStep();
    void refuseSteps(std::string_view reason, Cause cause);
    // Begins to load a scene for the server itself; call it only while no change is under way. `name`: of the scene,
    // for viewers. Clients may cancel or replace it as any change.
    void reload(const std::string& name, MakeScene make);
    // Returns true if a command waits for a checkpoint that has not begun.
    [[nodiscard]] bool asksForCheckpoint() const { return !checkpointsAsked_.empty(); }
    // The checkpoint for the commands that wait has begun.
    void checkpointBegun();
    // Answers the commands whose checkpoint has begun. `file`: its name.
    void answerCheckpoints(std::uint64_t step, const Result<std::string>& file);
    // Refuses all commands that have no answer yet, except those in the queue of requests.
    void refuseAll(const std::string& reason, Cause cause);

    // The change or the step command under way.
    struct Activity {
        const Request& request;
        Clock::time_point since;
        std::string doing;
        double share = 0;  // 0 to 1
    };
    [[nodiscard]] std::optional<Activity> activity() const;
    // Such as "load box-50k is under way (placing spheres, 34 %)"; empty if there is no change.
    [[nodiscard]] std::string changeInWords() const;

  private:
    struct Pending {
        Request request;
        Clock::time_point since;
    };
    struct Steps {
        Pending command;
        std::uint32_t left = 0;
    };

    // Queries for the hash of one state, which a thread computes.
    struct HashQueries {
        std::vector<Request> queries;
        sim::Applied answer;  // except the hash
        memory::Claim claim;  // for the copy of the state
        std::future<std::uint64_t> hash;
    };

    void answerInspections();
    void answerHashQueries();
    Result<HashQueries> beginHash();
    void refuseHashQueries(const std::string& reason, Cause cause);
    void serve(Request request);
    void execute(Request request);
    [[nodiscard]] std::uint64_t spheresOf(const v1::Command& command, const sim::Applied& applied) const;
    void finish(const Request& request, const Result<sim::Applied>& applied, const checkpoint::Keeper::Place& at);
    void refuseCheckpoints(const std::string& reason, Cause cause);
    std::optional<Result<sim::Applied>> apply(const Request& request);
    Request takeHeld();
    void refuse(const Request& request, const std::string& reason, Cause cause);
    void refuseChange(const std::string& reason, Cause cause);
    void refuseHeldSteps();
    Result<void> startRecording() override { return effects_.startRecording(); }
    Result<void> stopRecording() override { return effects_.stopRecording(); }
    Result<void> cancel() override;
    std::optional<Result<sim::Applied>> saveCheckpoint() override;

    SimulationHost& host_;
    Requests& requests_;
    net::Publisher& publisher_;
    Effects& effects_;
    std::optional<Pending> change_;              // command whose change is under way
    std::deque<Pending> held_;                   // commands that wait for the change to end
    std::size_t heldBytes_ = 0;                  // memory of these commands
    std::deque<Steps> steps_;                    // step commands with steps left, in order
    Result<sim::Applied> answer_;                // to queries; reused while nothing newer is needed
    std::optional<Clock::time_point> answered_;  // time of answer_; nullopt: a newer one is needed
    std::deque<Request> inspections_;            // that wait for their time
    Clock::time_point nextInspection_{};
    std::vector<Request> checkpointsAsked_, checkpointsBegun_;
    std::vector<Request> hashQueries_;    // queries for a hash that wait for the one under way
    std::optional<HashQueries> hashing_;  // under way
};

}  // namespace spherule::host

#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "spherule/v1/control.pb.h"

namespace spherule::host {

struct Request {
    std::uint64_t session = 0;
    v1::Command command;
    std::size_t bytes = 0;  // memory, as estimated before parsing
    bool answered = true;   // false: the server itself asks, and nobody waits for the result
};

// Commands and queries of sessions for the simulation thread. Commands wait in one queue per session. They are taken
// from the sessions in turn, and in order within a session. Queries and inspections change nothing and wait in a
// separate list, from which all are taken at once. Any thread.
class Requests {
  public:
    struct Limits {
        std::size_t commands = 512;
        std::size_t commandsPerSession = 128;
        std::size_t bytes = std::size_t{64} << 20U;  // of the waiting commands
        std::size_t bytesPerSession = std::size_t{32} << 20U;
        std::size_t queriesPerSession = 16;
    };
    using Refusal = std::optional<std::string>;  // the reason, for the sender; nullopt if accepted

    Requests() = default;
    explicit Requests(const Limits& limits) : limits_(limits) {}

    // Queues a request. Returns the reason if there is no room.
    [[nodiscard]] Refusal push(Request request);
    // Returns the reason if push() would refuse a command of this size now. The command has not been parsed yet.
    [[nodiscard]] Refusal refuses(std::uint64_t session, std::size_t bytes) const;

    // The session has ended or has lost control: its pull, if it has one, ends after its commands that wait.
    void release(std::uint64_t session);

    // Returns the next command; nullopt if there is none.
    std::optional<Request> tryPop();
    // Waits up to `timeout` for a command. Returns early when a query waits.
    std::optional<Request> popFor(std::chrono::nanoseconds timeout);
    // Removes and returns all waiting queries.
    std::vector<Request> takeQueries();

  private:
    struct Row {
        std::deque<Request> waiting;
        std::size_t bytes = 0;
    };

    [[nodiscard]] Refusal refusesLocked(std::uint64_t session, std::size_t bytes) const;
    std::optional<Request> popLocked();
    void addLocked(Request request);

    const Limits limits_{};
    mutable std::mutex mutex_;
    std::condition_variable ready_;
    std::map<std::uint64_t, Row> rows_;  // by session; no row is empty
    std::uint64_t last_ = 0;             // session of the last command taken
    std::set<std::uint64_t> pulling_;    // sessions that may have a pull
    std::size_t commands_ = 0;
    std::size_t bytes_ = 0;
    std::vector<Request> queries_;
    std::map<std::uint64_t, std::size_t> queriesOf_;
};

}  // namespace spherule::host

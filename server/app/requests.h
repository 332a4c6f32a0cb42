#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "spherule/v1/control.pb.h"

namespace spherule::app {

struct Request {
    std::uint64_t session = 0;
    v1::Command command;
    std::size_t bytes = 0;  // of memory, as estimated before it was parsed
};

// What sessions ask of the simulation thread, in two lanes. Commands that change anything wait in a queue per session,
// from which they are taken in turn: each session's in their order, one of each session that has any. Queries change
// nothing and wait apart: all of them are taken at once. Any thread.
class Requests {
  public:
    struct Limits {
        std::size_t commands = 512;
        std::size_t commandsPerSession = 128;
        std::size_t bytes = std::size_t{64} << 20U;  // of the commands that wait
        std::size_t bytesPerSession = std::size_t{32} << 20U;
        std::size_t queriesPerSession = 16;
    };
    using WhyNot = std::optional<std::string>;  // nothing: it is taken

    Requests() = default;
    explicit Requests(const Limits& limits) : limits_(limits) {}

    // Why it cannot wait too: for whoever sent it.
    [[nodiscard]] WhyNot push(Request request);
    // The same of a command that would take so many bytes, which is not there yet.
    [[nodiscard]] WhyNot refuses(std::uint64_t session, std::size_t bytes) const;

    // The next command.
    std::optional<Request> tryPop();
    // Waits up to `timeout` for one; not while queries wait.
    std::optional<Request> popFor(std::chrono::nanoseconds timeout);
    // All queries that wait.
    std::vector<Request> takeQueries();

  private:
    struct Row {
        std::deque<Request> waiting;
        std::size_t bytes = 0;
    };

    [[nodiscard]] WhyNot refusesLocked(std::uint64_t session, std::size_t bytes) const;
    std::optional<Request> popLocked();

    const Limits limits_{};
    mutable std::mutex mutex_;
    std::condition_variable ready_;
    std::map<std::uint64_t, Row> rows_;  // by session; none is empty
    std::uint64_t last_ = 0;             // the session whose turn it was
    std::size_t commands_ = 0;
    std::size_t bytes_ = 0;
    std::vector<Request> queries_;
    std::map<std::uint64_t, std::size_t> queriesOf_;
};

}  // namespace spherule::app

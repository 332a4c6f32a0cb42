#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/live.h"
#include "app/show.h"
#include "app/site.h"
#include "app/watchdog.h"
#include "net/server.h"

namespace spherule::app {

// Serves a show: owns its thread, the server and the watchdog, and joins them. After a device loss the show is not
// destroyed, because its driver might hang. End the program with endNow() then.
class Runtime {
  public:
    // Listens, and opens the show on its own thread. Until the show is open, /readyz answers 503 and no stream begins.
    // Fails if the address cannot be listened on.
    static Result<std::unique_ptr<Runtime>> start(const OpenShow& open, const net::Options& listen,
                                                  Watchdog::Seconds patience);
    ~Runtime();
    Runtime(const Runtime&) = delete;
    Runtime& operator=(const Runtime&) = delete;

    [[nodiscard]] std::uint16_t port() const { return server_->port(); }
    [[nodiscard]] LiveReport report() const { return live_.read(); }
    // Any thread. opened() returns true when the show is open. failure() returns why the show did not open or ended by
    // itself; nullopt if neither happened.
    [[nodiscard]] bool opened() const;
    [[nodiscard]] std::optional<Error> failure() const;
    Result<void> setCredentials(const net::Credentials& credentials) { return server_->setCredentials(credentials); }

    // Ends in this order: reports unready, accepts no connections, notifies the viewers, lets the current step and a
    // recording end, closes the sessions. Returns false when the show did not end in time or cannot be destroyed; end
    // the program then.
    [[nodiscard]] bool drain();

  private:
    explicit Runtime(Watchdog::Seconds patience);
    void present(const std::stop_token& stop, const OpenShow& open);
    Result<void> run(const std::stop_token& stop, const OpenShow& open);
    void hung(const Error& error);
    void beginToEnd(const std::optional<Error>& failure);
    void refuseWaiting();
    Outlets outlets();
    net::Handlers handlers();

    Live live_;
    Requests requests_;
    std::unique_ptr<Show> show_;  // used by thread_
    mutable std::mutex mutex_;    // guards the next three
    bool opened_ = false;
    bool ended_ = false;
    std::optional<Error> failure_;
    std::condition_variable changed_;
    Watchdog watchdog_;
    Site site_;
    std::unique_ptr<net::Server> server_;
    std::jthread thread_;
};

}  // namespace spherule::app

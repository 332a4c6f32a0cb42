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

// A show that is served: owns its thread, the server and the watchdog, and joins them. A show whose device is lost is
// not taken down, as its driver might hang: end the program (endNow) then.
class Runtime {
  public:
    // Listens, and opens the show on a thread of its own: until it is there, /readyz answers 503 and no stream begins.
    // An address that cannot be listened on is an error.
    static Result<std::unique_ptr<Runtime>> start(const OpenShow& open, const net::Options& listen,
                                                  Watchdog::Seconds patience);
    ~Runtime();
    Runtime(const Runtime&) = delete;
    Runtime& operator=(const Runtime&) = delete;

    [[nodiscard]] std::uint16_t port() const { return server_->port(); }
    [[nodiscard]] LiveReport report() const { return live_.read(); }
    // Any thread: whether the show has opened; why it did not, or ended by itself.
    [[nodiscard]] bool opened() const;
    [[nodiscard]] std::optional<Error> failure() const;
    Result<void> setCredentials(const net::Credentials& credentials) { return server_->setCredentials(credentials); }

    // In this order: is unready, accepts nobody, tells the viewers, lets the step under way and a recording end, lets
    // the viewers go. False: the show did not end in time, or cannot be taken down; end the program then.
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
    std::unique_ptr<Show> show_;  // of its thread
    mutable std::mutex mutex_;    // of the next three
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

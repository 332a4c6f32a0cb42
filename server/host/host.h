#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "host/frame_producer.h"
#include "host/http_routes.h"
#include "host/status_board.h"
#include "host/watchdog.h"
#include "net/server.h"

namespace spherule::host {

// Serves the frames of a producer: owns its thread (the simulation thread, also while a recording is played), the
// server and the watchdog, and joins them. After a device loss the producer is not destroyed, because its driver might
// hang. End the program with endNow() then.
class Host {
  public:
    // Reports an error on the terminal. Returns the exit code of the program.
    using PrintError = std::function<int(const Error&)>;

    // Listens, and creates the producer on its own thread. Until the producer exists, /readyz answers 503 and no stream
    // begins. Fails if the address cannot be listened on. If the device hangs for `watchdogLimit`, `printError` is
    // called on the watchdog's thread, and the program ends.
    static Result<std::unique_ptr<Host>> start(const ProducerFactory& create, const net::Options& listen,
                                               Watchdog::Seconds watchdogLimit, PrintError printError);
    ~Host();
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;

    [[nodiscard]] std::uint16_t port() const { return server_->port(); }
    [[nodiscard]] ServerStatus status() const { return board_.read(); }
    // Any thread. opened() returns true when the producer exists. failure() returns why the producer was not created or
    // ended by itself; nullopt if neither happened.
    [[nodiscard]] bool opened() const;
    [[nodiscard]] std::optional<Error> failure() const;
    Result<void> setCredentials(const net::Credentials& credentials) { return server_->setCredentials(credentials); }

    // Ends in this order: reports unready, accepts no connections, notifies the viewers, lets the current step and a
    // recording end, closes the sessions. Returns false when the producer did not end in time or cannot be destroyed;
    // end the program then.
    [[nodiscard]] bool drain();

  private:
    Host(Watchdog::Seconds watchdogLimit, PrintError printError);
    void runThread(const std::stop_token& stop, const ProducerFactory& create);
    Result<void> run(const std::stop_token& stop, const ProducerFactory& create);
    void hung(const Error& error);
    void beginShutdown(const std::optional<Error>& failure);
    void refuseWaiting();
    net::Handlers handlers();

    StatusBoard board_;
    Requests requests_;
    SceneSaver saver_;
    std::unique_ptr<FrameProducer> producer_;  // used by thread_
    mutable std::mutex mutex_;                 // guards the next three
    bool opened_ = false;
    bool ended_ = false;
    std::optional<Error> failure_;
    std::condition_variable changed_;
    Watchdog watchdog_;
    HttpRoutes routes_;
    std::unique_ptr<net::Server> server_;
    PrintError printError_;
    std::jthread thread_;
};

}  // namespace spherule::host

#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "app/live.h"
#include "app/show.h"
#include "app/site.h"
#include "core/bounded_queue.h"
#include "net/server.h"

namespace spherule::app {

// A show that is served: owns its thread and the server, and joins them.
class Runtime {
  public:
    // Opens the show and listens; returns when both is done.
    static Result<std::unique_ptr<Runtime>> start(const OpenShow& open, const net::Options& listen);
    ~Runtime();
    Runtime(const Runtime&) = delete;
    Runtime& operator=(const Runtime&) = delete;

    [[nodiscard]] std::uint16_t port() const { return server_->port(); }
    [[nodiscard]] LiveReport report() const { return live_.read(); }
    // Why the show ended by itself, when it did. Any thread.
    [[nodiscard]] std::optional<Error> failure() const;
    Result<void> setSecrets(const net::Secrets& secrets) { return server_->setSecrets(secrets); }
    // Tells the viewers, lets them go, stops.
    void drain();

  private:
    Runtime() = default;
    void present(const std::stop_token& stop, const OpenShow& open, std::promise<Result<void>>& ready);
    void settle();
    Outlets outlets();
    net::Handlers handlers();

    Live live_;
    BoundedQueue<Request> requests_{256};
    Site site_{live_};
    std::unique_ptr<net::Server> server_;
    std::atomic<bool> settled_ = false;  // whether the server has started, or will not
    std::atomic<bool> failed_ = false;
    Error failure_;  // valid once failed_ is set
    std::jthread show_;
};

}  // namespace spherule::app

#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "client/client.h"
#include "net/server.h"
#include "temporary_folder.h"

namespace spherule::net {

using client::Client;
using client::CloseFrame;
using namespace std::chrono_literals;

constexpr auto patience = 10s;  // timeout; only a failing test waits this long

// Timeouts that are short enough for tests and long enough for a busy machine. No limits per address.
Options quickOptions();

codec::SharedMessage factsOf(std::uint32_t epoch, std::uint32_t spheres);
codec::SharedMessage orderOf(std::uint32_t epoch);  // its number is the epoch
// A frame with `number` as sequence, step and content.
codec::EncodedFrame encodedFrame(codec::EncodedFrame::Kind kind, std::uint32_t number, std::uint32_t epoch,
                                 std::uint32_t spheres, const codec::Rendition& rendition = {v1::NORMAL, 60});
codec::SharedMessage eventOf(const std::string& text, v1::Event::Kind kind = v1::Event::WARNING);

// Waits until `condition` holds; returns false when `patience` has passed.
bool eventually(const std::function<bool()>& condition);

// A server on a free port, with an application that simulates nothing. It has one file, at /file, and one
// download, at /recordings/one.sph, and a scene of three parts. The file of /recordings/gone.sph has been deleted.
class FakeApp {
  public:
    explicit FakeApp(const Options& options = quickOptions());
    ~FakeApp();
    FakeApp(const FakeApp&) = delete;
    FakeApp& operator=(const FakeApp&) = delete;

    Server& server() { return *server_; }
    const Counters& counters() { return server_->counters(); }
    [[nodiscard]] std::string url() const;

    // Publishes the next frame of each rendition, and a resync keyframe if a session waits for one.
    void publish(std::uint32_t spheres);
    // Calls publish() periodically from its own thread.
    void publishEvery(std::chrono::milliseconds period, std::uint32_t spheres);
    void stopPublishing();
    [[nodiscard]] std::uint32_t published() const { return number_; }
    void setEpoch(std::uint32_t epoch);

    std::atomic<bool> takesCommands = true;  // false: submit() refuses
    std::atomic<bool> takesLong = true;      // false: refuses() refuses
    std::atomic<bool> throws = false;        // submit() and get() throw std::bad_alloc
    std::vector<v1::Command> commands();
    std::vector<SessionId> silenced();  // sessions that may not command any more
    // While true, the next command blocks the io thread; `held` is true then.
    std::atomic<bool> hold = false;
    std::atomic<bool> held = false;

  private:
    Handlers handlers();

    support::TemporaryFolder folder_;  // of one.sph
    std::unique_ptr<Server> server_;
    std::mutex mutex_;
    std::vector<v1::Command> commands_;
    std::vector<SessionId> silenced_;
    std::atomic<std::uint32_t> epoch_ = 1;
    std::atomic<std::uint32_t> number_ = 0;
    std::jthread publisher_;
};

v1::ClientMessage helloOf(std::uint32_t rate);

// Connects; does not send hello.
std::unique_ptr<Client> connect(const FakeApp& app);
// Connects and reads welcome, stream, facts, settings, and the order if `rate` > 0.
std::unique_ptr<Client> join(const FakeApp& app, std::uint32_t rate, Encoding encoding = Encoding::Binary);

// Returns the next message. If there is none, the test fails and the message is empty.
v1::ServerMessage next(Client& client);
// Reads until the server closes, and returns its close frame.
CloseFrame readToEnd(Client& client);

}  // namespace spherule::net

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

namespace spherule::net {

using client::Client;
using client::CloseFrame;
using namespace std::chrono_literals;

constexpr auto patience = 10s;  // for what must happen; only a failing test waits that long

// Limits short enough for a test that waits for them, long enough for a busy machine.
Options quickOptions();

codec::SharedMessage factsOf(std::uint32_t epoch, std::uint32_t spheres);
codec::SharedMessage orderOf(std::uint32_t epoch);  // with the epoch's number
// Of a chain of rendition `normal`.
codec::EncodedFrame encodedFrame(codec::EncodedFrame::Kind kind, std::uint32_t number, std::uint32_t epoch,
                                 std::uint32_t spheres, const codec::Rendition& rendition = {v1::NORMAL, 60});
codec::SharedMessage eventOf(const std::string& text, v1::Event::Kind kind = v1::Event::WARNING);

// True as soon as `condition` holds; false when patience is over.
bool eventually(const std::function<bool()>& condition);

// A server on any free port, with an app that simulates nothing.
class FakeApp {
  public:
    explicit FakeApp(const Options& options = quickOptions());
    ~FakeApp();
    FakeApp(const FakeApp&) = delete;
    FakeApp& operator=(const FakeApp&) = delete;

    Server& server() { return *server_; }
    const Counters& counters() { return server_->counters(); }
    [[nodiscard]] std::string url() const;

    // Publishes to each chain that is watched the next frame, of the current epoch, and a keyframe to who waits for
    // one.
    void publish(std::uint32_t spheres);
    // The same from a thread of its own.
    void publishEvery(std::chrono::milliseconds period, std::uint32_t spheres);
    void stopPublishing();
    [[nodiscard]] std::uint32_t published() const { return number_; }
    void setEpoch(std::uint32_t epoch);

    // What submit answers.
    std::atomic<bool> takesCommands = true;
    std::atomic<bool> takesLong = true;  // or has no room for what is long
    std::atomic<bool> throws = false;    // it, and what is asked by HTTP, runs out of memory instead
    std::vector<v1::Command> commands();
    // Keeps the io thread busy with the next command until it is false again.
    std::atomic<bool> hold = false;
    std::atomic<bool> held = false;

  private:
    Handlers handlers();

    std::unique_ptr<Server> server_;
    std::mutex mutex_;
    std::vector<v1::Command> commands_;
    std::atomic<std::uint32_t> epoch_ = 1;
    std::atomic<std::uint32_t> number_ = 0;
    std::jthread publisher_;
};

v1::ClientMessage helloOf(std::uint32_t rate);

// Connected, no hello yet.
std::unique_ptr<Client> connect(const FakeApp& app);
// After welcome, what is said of the stream, facts, settings, and the order where there is a rate.
std::unique_ptr<Client> join(const FakeApp& app, std::uint32_t rate, Encoding encoding = Encoding::Binary);

// The next message; a failed expectation and an empty one when there is none.
v1::ServerMessage next(Client& client);
// Reads on until the server closes; the close frame.
CloseFrame readToEnd(Client& client);

}  // namespace spherule::net

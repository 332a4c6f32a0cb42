#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "frame/message.h"
#include "net/server.h"

namespace spherule::net {

// A session as the hub sees it. Any thread; no call does its work before it returns, so the hub may hold its lock.
class Subscriber {
  public:
    virtual ~Subscriber() = default;
    virtual void send(frame::SharedMessage message) = 0;  // reliable lane
    virtual void offer(frame::SharedMessage state) = 0;   // lossy lane; not before the facts of its epoch
    virtual void drain() = 0;                             // close when the reliable lane is empty
    virtual void drop() = 0;                              // now, without a close frame
};

// Hands every message to the sessions that want it, and to a newcomer what it missed. Any thread.
class Hub {
  public:
    SessionId add(std::shared_ptr<Subscriber> session);
    void remove(SessionId id);
    // After the welcome: the session gets facts, settings, dial, and `rate` states per second.
    void join(SessionId id, std::uint32_t rate);

    void setScene(frame::SharedMessage facts);
    void setSettings(frame::SharedMessage settings);
    void setDial(frame::SharedMessage dial);
    void publish(frame::SharedMessage state);
    void broadcast(const frame::SharedMessage& message);
    void sendTo(SessionId id, frame::SharedMessage message);

    [[nodiscard]] std::uint32_t viewers() const { return viewers_; }
    [[nodiscard]] std::uint64_t joins() const { return joins_; }
    [[nodiscard]] std::uint32_t rate() const { return rate_; }

    // Closes what is open and whatever comes later.
    void drain();
    void dropAll();
    // False when sessions are left after `timeout`.
    bool waitEmpty(std::chrono::milliseconds timeout);

  private:
    struct Entry {
        std::shared_ptr<Subscriber> session;
        bool joined = false;
        std::uint32_t rate = 0;
    };

    void keep(frame::SharedMessage& kept, frame::SharedMessage message);
    void countViewers();

    std::mutex mutex_;
    std::condition_variable emptied_;
    std::unordered_map<SessionId, Entry> entries_;
    SessionId lastId_ = 0;
    bool draining_ = false;
    frame::SharedMessage scene_;
    frame::SharedMessage settings_;
    frame::SharedMessage dial_;
    frame::SharedMessage latest_;  // kept only while somebody watches: later it would be old
    std::atomic<std::uint32_t> viewers_ = 0;
    std::atomic<std::uint64_t> joins_ = 0;
    std::atomic<std::uint32_t> rate_ = 0;
};

}  // namespace spherule::net

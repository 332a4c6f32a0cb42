#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "codec/rendition.h"
#include "net/session_id.h"

namespace spherule::net {

// A session as the hub sees it. Any thread; no call does its work before it returns, so the hub may hold its lock.
class Subscriber {
  public:
    virtual ~Subscriber() = default;
    virtual void send(codec::SharedMessage message) = 0;  // reliable lane
    virtual void offer(codec::EncodedFrame encoded) = 0;  // lossy lane
    virtual void drain() = 0;                             // close when the reliable lane is empty
    virtual void drop() = 0;                              // now, without a close frame
};

// Hands every message to the sessions that want it, and to a newcomer what it missed. Any thread.
class Hub {
  public:
    SessionId add(std::shared_ptr<Subscriber> session);
    void remove(SessionId id);
    // After the welcome: the session gets what is kept.
    void join(SessionId id);
    // The chain that the session is sent from now on, from its next keyframe on; rate 0: none.
    void subscribe(SessionId id, const codec::Rendition& rendition);
    // The session has lost its chain and needs a keyframe.
    void requestKeyframe(SessionId id);

    // For all and for newcomers, until there is a newer one of its kind.
    void retain(codec::SharedMessage message);
    // For the frames that come; to whoever watches.
    void setOrder(codec::SharedMessage order);
    void publish(const codec::EncodedFrame& encoded);
    void broadcast(const codec::SharedMessage& message);
    void sendTo(SessionId id, codec::SharedMessage message);

    [[nodiscard]] std::uint32_t viewers() const { return viewers_; }
    // Of each chain that somebody watches.
    [[nodiscard]] std::vector<codec::Subscription> subscriptions();

    // Closes what is open and whatever comes later.
    void drain();
    void dropAll();
    // False when sessions are left after `timeout`.
    bool waitEmpty(std::chrono::milliseconds timeout);

  private:
    struct Entry {
        std::shared_ptr<Subscriber> session;
        bool joined = false;
        codec::Rendition rendition{};  // rate 0: none
        bool newcomer = false;         // no frame of the chain has come yet
        bool lost = false;
    };

    Entry* find(SessionId id);
    void countViewers();

    std::mutex mutex_;
    std::condition_variable emptied_;
    std::unordered_map<SessionId, Entry> entries_;
    SessionId lastId_ = 0;
    bool draining_ = false;
    std::map<v1::ServerMessage::KindCase, codec::SharedMessage> retained_;  // in the order in which newcomers get them
    codec::SharedMessage order_;
    std::atomic<std::uint32_t> viewers_ = 0;
};

}  // namespace spherule::net

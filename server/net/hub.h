#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "codec/rendition.h"
#include "net/session_id.h"

namespace spherule::net {

// Interface of a session for the hub. Any thread. Calls only post work, so the hub may hold its lock.
class Subscriber {
  public:
    virtual ~Subscriber() = default;
    virtual void send(codec::SharedMessage message) = 0;  // reliable lane
    virtual void offer(codec::EncodedFrame encoded) = 0;  // lossy lane
    virtual void drain() = 0;                             // close after the reliable lane is empty
    virtual void drop() = 0;                              // close at once, without a close frame
};

// Distributes messages to the sessions, and retained messages to new sessions. Any thread.
class Hub {
  public:
    SessionId add(std::shared_ptr<Subscriber> session);
    void remove(SessionId id);
    // Sends the retained messages. Call after the welcome.
    void join(SessionId id, const std::string& client, bool followsPopulation);
    // Sends the scene facts again: the session has missed changes of the population.
    void resendScene(SessionId id);
    // Sends frames of this rendition from its next keyframe on. Rate 0: no frames.
    void subscribe(SessionId id, const codec::Rendition& rendition);
    // The session has lost its chain and needs a keyframe.
    void requestKeyframe(SessionId id);

    // Sends to the audience. New sessions get the newest message of each kind.
    void retain(codec::SharedMessage message, codec::Audience audience = codec::Audience::Everybody);
    // Sets the order of the spheres in the next frames and sends it to the sessions of the audience that want frames.
    void setOrder(codec::SharedMessage order, codec::Audience audience);
    // Sends a Population message to all followers. New ones get it after the scene facts.
    void follow(codec::SharedMessage population);
    // Replaces the followers' facts of the present epoch, for new sessions: they include all changes so far.
    void refreshScene(codec::SharedMessage scene);
    void publish(const codec::EncodedFrame& encoded);
    void broadcast(const codec::SharedMessage& message);
    // Sends an event to all sessions but the one that caused it, whose client it names.
    void announce(SessionId by, v1::Event event);
    void sendTo(SessionId id, codec::SharedMessage message);

    [[nodiscard]] std::uint32_t viewers() const { return viewers_; }
    // One entry for each rendition that a session wants.
    [[nodiscard]] std::vector<codec::Subscription> subscriptions();

    // Closes all sessions, and each session that is added later.
    void drain();
    void dropAll();
    // Returns false when sessions are left after `timeout`.
    bool waitEmpty(std::chrono::milliseconds timeout);

  private:
    struct Entry {
        std::shared_ptr<Subscriber> session;
        bool joined = false;
        std::string client{};  // name in its hello
        bool follows = false;
        codec::Rendition rendition{};  // rate 0: no frames
        bool newcomer = false;         // has had no frame of the rendition yet
        bool lost = false;
    };

    Entry* find(SessionId id);
    void countViewers();

    std::mutex mutex_;
    std::condition_variable emptied_;
    std::unordered_map<SessionId, Entry> entries_;
    SessionId lastId_ = 0;
    bool draining_ = false;
    // The messages about the scene for an audience.
    struct SceneState {
        codec::SharedMessage facts;
        codec::SharedMessage order;
        std::vector<codec::SharedMessage> changes;  // Population messages since the facts
    };
    void sendScene(Entry& entry);
    SceneState& sceneFor(const Entry& entry) { return entry.follows ? followers_ : others_; }
    static bool isAmong(const Entry& entry, codec::Audience audience);

    SceneState followers_, others_;
    std::map<v1::ServerMessage::KindCase, codec::SharedMessage> retained_;  // sent to new sessions in this order
    std::atomic<std::uint32_t> viewers_ = 0;
};

}  // namespace spherule::net

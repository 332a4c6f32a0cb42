#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "codec/message.h"
#include "codec/rendition.h"
#include "net/session_id.h"
#include "spherule/v1/control.pb.h"

namespace spherule::net {

// Sends messages and frames to the sessions, and returns what they want. Any thread.
class Publisher {
  public:
    Publisher() = default;
    virtual ~Publisher() = default;
    Publisher(const Publisher&) = delete;
    Publisher& operator=(const Publisher&) = delete;

    // Sends to the audience. A new session gets the newest message of each kind after its welcome. `audience`: only for
    // scene facts and orders.
    virtual void retain(codec::SharedMessage message, codec::Audience audience) = 0;
    void retain(codec::SharedMessage message) { retain(std::move(message), codec::Audience::Everybody); }
    // Sets the order of the spheres in the next frames. Call after retain() of their scene facts.
    virtual void setOrder(codec::SharedMessage order, codec::Audience audience) = 0;
    // Sends a Population message to the followers. New ones get it after the scene facts.
    virtual void follow(codec::SharedMessage population) = 0;
    // Replaces the followers' facts of the present epoch, for new sessions: they include all changes so far.
    virtual void refreshScene(codec::SharedMessage scene) = 0;
    // Lossy lane. A session that has not sent the previous frame yet has lost the chain: it gets no frame before the
    // next keyframe. A frame waits until the scene facts and the order that it belongs to have been sent.
    virtual void publish(const codec::EncodedFrame& encoded) = 0;
    // Reliable lane. Messages that describe a current state replace queued ones of their kind.
    virtual void broadcast(codec::SharedMessage message) = 0;
    // Sends an event that a session has caused to all other sessions. Adds `by`, the session with its client's name.
    virtual void announce(SessionId by, v1::Event event) = 0;
    virtual void reply(SessionId session, v1::CommandResult result) = 0;

    [[nodiscard]] virtual std::uint32_t viewers() const = 0;  // sessions that want frames
    // The renditions that sessions want, and whether a session waits for a keyframe of them.
    [[nodiscard]] virtual std::vector<codec::Subscription> subscriptions() = 0;
};

}  // namespace spherule::net

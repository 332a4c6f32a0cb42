#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "net/session_id.h"
#include "spherule/v1/control.pb.h"

namespace spherule::net {

// Gives one session at a time the right to send commands that change the world. A session acquires the free lock, and
// its holder hands it over. When the holder's session ends, the lock passes to the oldest request, or is free. Does not
// check roles. Used on the io thread.
class ControlLock {
  public:
    // `notify` is called after each change, with the new state.
    explicit ControlLock(std::function<void(const v1::Control&)> notify) : notify_(std::move(notify)) {}

    // Acquires the lock if it is free. Returns false when another session holds it.
    bool acquire(SessionId session, const std::string& client);
    // Acquires the lock if it is free, else queues a request to its holder (at most 16 requests).
    void request(SessionId session, const std::string& client);
    // Holder: passes the lock to `to`; if 0, to the first request, or frees it. Requester: withdraws its request.
    // Others: no effect.
    void release(SessionId session, SessionId to);
    // Holder: discards all requests.
    void denyRequests(SessionId session);
    // Same as release(session, 0).
    void onSessionEnded(SessionId session);

    [[nodiscard]] const v1::Control& state() const { return state_; }

  private:
    [[nodiscard]] bool holds(SessionId session) const;
    [[nodiscard]] int requestIndex(SessionId session) const;  // index of the session's request, or -1
    void grant(SessionId session, const std::string& client);
    void passOn();
    void notify() const { notify_(state_); }

    std::function<void(const v1::Control&)> notify_;
    v1::Control state_;
};

}  // namespace spherule::net

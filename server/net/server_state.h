#pragma once

#include <memory>
#include <string>
#include <utility>

#include "net/control_lock.h"
#include "net/counters.h"
#include "net/hub.h"
#include "net/rejection_log.h"
#include "net/server.h"
#include "net/tls.h"

namespace spherule::net {

// State shared by the listener, HTTP connections and sessions; must outlive them.
struct ServerState {
    Options options;
    Handlers handlers;
    Counters counters{};
    Hub hub{};
    RejectionLog rejectionLog{counters};
    // Replaced when the credentials change. Used on the io thread.
    std::shared_ptr<const Admission> admission{};
    Tls tls{};
    std::shared_ptr<ConnectionLimiter> limiter = std::make_shared<ConnectionLimiter>(options.connectionLimits);
    // One session at a time controls the world, if clients have tokens or the server is open to all.
    bool exclusiveControl = options.open || requiresToken(options.credentials);
    SessionId holder = 0;  // of control; 0: none
    ControlLock controlLock{[this](const v1::Control& now) { publishControl(now); }};

    // Sends the state of the control lock to all sessions.
    void publishControl(const v1::Control& now) {
        if (!exclusiveControl) return;
        const SessionId before = std::exchange(holder, now.has_holder() ? now.holder().session() : 0);
        if (before != 0 && before != holder) handlers.mayNotCommand(before);
        v1::ServerMessage message;
        *message.mutable_control() = now;
        hub.retain(codec::share(std::move(message)));
    }
};

}  // namespace spherule::net

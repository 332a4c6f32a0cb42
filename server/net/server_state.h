#pragma once

#include <memory>
#include <string>

#include "net/control_lock.h"
#include "net/counters.h"
#include "net/hub.h"
#include "net/rejection_log.h"
#include "net/server.h"
#include "net/tls.h"

namespace spherule::net {

// What listener, HTTP connections and sessions share; outlives them all.
struct ServerState {
    Options options;
    Handlers handlers;
    Counters counters{};
    Hub hub{};
    RejectionLog rejectionLog{counters};
    // These change with the credentials. On the io thread.
    std::shared_ptr<const Admission> admission{};
    Tls tls{};
    std::shared_ptr<ConnectionLimiter> limiter = std::make_shared<ConnectionLimiter>(options.connectionLimits);
    // Where it is known who is who, or that anybody may come, one at a time has the controls.
    bool exclusiveControl = options.open || requiresToken(options.credentials);
    ControlLock controlLock{[this](const v1::Control& now) { publishControl(now); }};

    void publishControl(const v1::Control& now) {
        if (!exclusiveControl) return;
        v1::ServerMessage message;
        *message.mutable_control() = now;
        hub.retain(codec::share(std::move(message)));
    }
};

}  // namespace spherule::net

#pragma once

#include <memory>
#include <string>

#include "net/counters.h"
#include "net/hub.h"
#include "net/lease.h"
#include "net/refusals.h"
#include "net/server.h"
#include "net/tls.h"

namespace spherule::net {

// What listener, HTTP connections and sessions share; outlives them all.
struct Context {
    Options options;
    Handlers handlers;
    Counters counters{};
    Hub hub{};
    Refusals refusals{counters};
    // These change with the credentials. On the io thread.
    std::shared_ptr<const Admission> admission{};
    Tls tls{};
    std::shared_ptr<ConnectionLimiter> limiter = std::make_shared<ConnectionLimiter>(options.connectionLimits);
    // Where it is known who is who, or that anybody may come, one at a time has the controls.
    bool leased = options.open || requiresToken(options.credentials);
    Lease lease{[this](const v1::Control& now) { tellControl(now); }};

    void tellControl(const v1::Control& now) {
        if (!leased) return;
        v1::ServerMessage message;
        *message.mutable_control() = now;
        hub.retain(codec::share(std::move(message)));
    }
};

}  // namespace spherule::net

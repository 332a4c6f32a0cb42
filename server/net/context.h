#pragma once

#include "net/counters.h"
#include "net/hub.h"
#include "net/server.h"

namespace spherule::net {

// What listener, HTTP connections and sessions share; outlives them all.
struct Context {
    Options options;
    Handlers handlers;
    Counters counters{};
    Hub hub{};
};

}  // namespace spherule::net

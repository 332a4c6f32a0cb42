#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "app/live.h"
#include "app/requests.h"
#include "codec/message.h"
#include "codec/rendition.h"
#include "core/result.h"

namespace spherule::app {

// Where results go; called on the show's thread.
struct Outlets {
    std::function<void(codec::SharedMessage)> retain;     // scene facts, settings, dial, ...: newcomers get them too
    std::function<void(codec::SharedMessage)> broadcast;  // events, diagnostics
    std::function<void(codec::SharedMessage)> order;
    std::function<void(const codec::EncodedFrame&)> frame;
    std::function<void(std::uint64_t session, v1::CommandResult)> reply;
    std::function<std::uint32_t()> viewers;
    std::function<std::vector<codec::Subscription>()> subscriptions;
};

// What a show has to do with: what is asked of it, what it says of itself, where its results go.
struct Stage {
    Requests& requests;
    Live& live;
    Outlets outlets;
};

// What a server shows: a simulation, or a recording. Made, used and destroyed by one thread.
class Show {
  public:
    Show() = default;
    virtual ~Show() = default;
    Show(const Show&) = delete;
    Show& operator=(const Show&) = delete;

    // Until stopped, or an error ends it.
    virtual Result<void> run(const std::stop_token& stop) = 0;
};

// Opens device and scene or file, and fills in what `live` says of them. The outlets are open once it has returned.
using OpenShow = std::function<Result<std::unique_ptr<Show>>(const Stage& stage)>;

}  // namespace spherule::app

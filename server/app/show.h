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

// Destinations of the results. Called on the show's thread.
struct Outlets {
    std::function<void(codec::SharedMessage)> retain;     // scene facts, settings, dial, ...; sent to new sessions too
    std::function<void(codec::SharedMessage)> broadcast;  // events, diagnostics
    std::function<void(codec::SharedMessage)> order;
    std::function<void(const codec::EncodedFrame&)> frame;
    std::function<void(std::uint64_t session, v1::CommandResult)> reply;
    std::function<std::uint32_t()> viewers;
    std::function<std::vector<codec::Subscription>()> subscriptions;
};

// The requests to a show, its report about itself, and the destinations of its results.
struct Stage {
    Requests& requests;
    Live& live;
    Outlets outlets;
};

// A simulation or a recording that a server shows. Created, used and destroyed by one thread.
class Show {
  public:
    Show() = default;
    virtual ~Show() = default;
    Show(const Show&) = delete;
    Show& operator=(const Show&) = delete;

    // Runs until stopped, or until an error.
    virtual Result<void> run(const std::stop_token& stop) = 0;
};

// Opens the device and the scene or file, and fills in their entries in `live`. The outlets may be used once it has
// returned.
using OpenShow = std::function<Result<std::unique_ptr<Show>>(const Stage& stage)>;

}  // namespace spherule::app

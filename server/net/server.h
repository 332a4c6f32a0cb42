#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codec/rendition.h"
#include "core/result.h"
#include "net/admission.h"
#include "net/connection_limiter.h"
#include "net/counters.h"
#include "net/session_id.h"
#include "spherule/v1/control.pb.h"

// One port: the page, health, metrics and the WebSocket stream. Knows nothing of the simulation.
namespace spherule::net {

struct Options {
    std::string host = "127.0.0.1";
    std::uint16_t port = 8080;  // 0: any free one
    // Without tokens, an address that others reach is listened on only where everybody may view and command.
    bool open = false;
    AllowedNames allowedNames;
    Credentials credentials;
    ConnectionLimits connectionLimits;
    double commandsPerSecond = 100;                       // of one session; as many at once; 0: no limit
    std::chrono::milliseconds guessDelay{1'000};          // before a wrong token is answered
    std::size_t firstMessageBytes = 4096;                 // of a hello, and of all that viewers send
    std::size_t maxMessageBytes = 1U << 20U;              // of controllers; a longer one closes with 1009
    std::size_t maxMessageCost = std::size_t{16} << 20U;  // bytes of memory for a parsed message; beyond, it is refused
    std::size_t controlQueue = 64;                        // messages per session; overflow closes with 1013
    std::chrono::milliseconds progressTimeout{10'000};    // a write without progress for this long ends the session
    std::chrono::milliseconds idleTimeout{60'000};        // a silent peer is pinged, then dropped
    std::chrono::milliseconds helloTimeout{10'000};       // for the client's first message
    std::chrono::milliseconds requestTimeout{10'000};  // for a request, from its connection or from the answer before
    std::chrono::milliseconds drainTimeout{10'000};
};

struct HttpAnswer {
    int status = 200;
    std::string contentType;
    std::string body;
};

// What the server asks of its app. Called on the io thread: must not wait. What is thrown ends the session or the
// connection.
struct Handlers {
    std::function<v1::Welcome(const v1::Hello&)> welcome;
    using Refusal = std::optional<std::string>;  // nothing: it is taken
    // `cost`: bytes of memory, as Preview estimates them.
    std::function<Refusal(SessionId, v1::Command, std::size_t cost)> submit;
    // Whether a command of that cost would be taken now: asked before a long one is parsed.
    std::function<Refusal(SessionId, std::size_t cost)> refuses = [](SessionId, std::size_t) { return Refusal(); };
    std::function<bool()> ready = [] { return true; };  // false: there is no stream yet, it is refused with 503
    // status 404 where there is nothing; `counters` are the server's.
    std::function<HttpAnswer(const std::string& path, const Counters& counters)> get;
};

class Server {
  public:
    virtual ~Server() = default;
    [[nodiscard]] virtual std::uint16_t port() const = 0;

    // Any thread from here on.
    // All clients get it, and those who come later after their welcome: the newest of each kind.
    virtual void retain(codec::SharedMessage message) = 0;
    // For who watches: the order of the spheres in the frames that come, once their scene facts are kept.
    virtual void setOrder(codec::SharedMessage order) = 0;
    // Lossy lane: who could not be sent the frame before has lost the chain, and is sent nothing more of it before a
    // keyframe. A frame of another epoch than the scene's, or of another order, waits for that.
    virtual void publish(const codec::EncodedFrame& encoded) = 0;
    // Reliable lane; diagnostics, as what is kept, take the place of older ones that wait.
    virtual void broadcast(codec::SharedMessage message) = 0;
    virtual void reply(SessionId session, v1::CommandResult result) = 0;

    [[nodiscard]] virtual std::uint32_t viewers() const = 0;  // sessions that want frames
    // The chains that are watched, and whether somebody waits for a keyframe: no frame comes to them before.
    [[nodiscard]] virtual std::vector<codec::Subscription> subscriptions() = 0;

    // Closes the port; who is connected stays.
    virtual void stopAccepting() = 0;
    // Stops accepting, closes sessions with 1012 after what is queued, waits up to drainTimeout.
    // Not from the io thread.
    virtual void drain() = 0;

    // Tokens and certificate for whoever comes from now on. Whether there are any cannot change. An error: the old ones
    // stay. Not from the io thread.
    virtual Result<void> setCredentials(const Credentials& credentials) = 0;

    [[nodiscard]] virtual const Counters& counters() const = 0;
};

// Binds and starts the io thread. TLS is spoken where there is a certificate.
Result<std::unique_ptr<Server>> startServer(const Options& options, Handlers handlers);

}  // namespace spherule::net

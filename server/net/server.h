#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"
#include "net/admission.h"
#include "net/connection_limiter.h"
#include "net/counters.h"
#include "net/publisher.h"
#include "net/session_id.h"
#include "net/static_file.h"
#include "spherule/v1/control.pb.h"

// Serves the page, health, metrics and the WebSocket stream on one port. Independent of the simulation.
namespace spherule::net {

struct Options {
    std::string host = "127.0.0.1";
    std::uint16_t port = 8080;  // 0: any free one
    // Lets everybody view and command without a token. Required for an address that other machines reach, if there are
    // no tokens.
    bool open = false;
    AllowedNames allowedNames;
    Credentials credentials;
    ConnectionLimits connectionLimits;
    double commandsPerSecond = 100;                       // per session, average and burst; 0: no limit
    std::chrono::milliseconds guessDelay{1'000};          // delay before the answer to a wrong token
    std::size_t firstMessageBytes = 4096;                 // limit for a hello, and for each message of a viewer
    std::size_t maxMessageBytes = 1U << 20U;              // limit for controllers; a longer message closes with 1009
    std::size_t maxMessageCost = std::size_t{16} << 20U;  // memory for a parsed message (bytes); above, it is refused
    std::size_t controlQueue = 64;                        // messages per session; overflow closes with 1013
    std::chrono::milliseconds progressTimeout{10'000};    // ends a session whose write makes no progress
    std::chrono::milliseconds idleTimeout{60'000};        // pings a silent peer at half the time, then drops it
    std::chrono::milliseconds helloTimeout{10'000};       // for the client's first message
    std::chrono::milliseconds requestTimeout{10'000};     // for a request, since the connection or the last answer
    std::chrono::milliseconds drainTimeout{10'000};
};

// Files below this path require a token, if the server has tokens.
constexpr std::string_view downloadsPath = "/recordings/";
// The present state as a scene file. Requires a token, as recordings do.
constexpr std::string_view scenePath = "/scene.json";

struct HttpAnswer {
    int status = 200;
    std::string contentType;
    std::string body;
};

// A text that is made part by part, while it is sent. Used on the io thread.
class Document {
  public:
    Document() = default;
    virtual ~Document() = default;
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;

    virtual std::string next() = 0;  // the next part; empty at the end
};

// Callbacks into the application. Called on the io thread; must not block. An exception ends the session or the
// connection.
struct Handlers {
    std::function<v1::Welcome(const v1::Hello&)> welcome;
    using Refusal = std::optional<std::string>;  // the reason; nullopt if accepted
    // Queues a command. `cost`: memory (bytes), estimated by previewOf().
    std::function<Refusal(SessionId, v1::Command, std::size_t cost)> submit;
    // A session that has sent commands has ended, or another one has control now.
    std::function<void(SessionId)> mayNotCommand = [](SessionId) {};
    // Tells whether a command of this cost would be refused now. Called before a long command is parsed.
    std::function<Refusal(SessionId, std::size_t cost)> refuses = [](SessionId, std::size_t) { return Refusal(); };
    std::function<bool()> ready = [] { return true; };  // false: the stream is refused with 503
    // The file at `path`, which lives as long as the server. Null if there is none; `get` then answers.
    std::function<const StaticFile*(const std::string& path)> file = [](const std::string&) { return nullptr; };
    // The file on the disk to send for a path below downloadsPath, which clients get as an attachment. nullopt if there
    // is none; `get` then answers. Called only for clients that may watch.
    std::function<std::optional<std::string>(const std::string& path)> download = [](const std::string&) {
        return std::nullopt;
    };
    // Makes the document at scenePath, and passes it to `made`, later and on any thread. `made` gets a refusal if there
    // is none. Called only for clients that may watch.
    using Made = std::function<void(std::shared_ptr<Document>, HttpAnswer refusal)>;
    std::function<void(Made made)> saveScene = [](const Made& made) {
        made(nullptr, {404, "text/plain; charset=utf-8", "This server has no scene.\n"});
    };
    // Answers GET. Status 404 if there is nothing at `path`. `counters`: of the server.
    std::function<HttpAnswer(const std::string& path, const Counters& counters)> get;
};

class Server : public Publisher {
  public:
    // All calls: any thread, unless noted.
    [[nodiscard]] virtual std::uint16_t port() const = 0;

    // Closes the port; open connections stay.
    virtual void stopAccepting() = 0;
    // Stops accepting, closes each session with 1012 after its queued messages, and waits up to drainTimeout. Blocks:
    // do not call on the io thread.
    virtual void drain() = 0;

    // Replaces tokens and certificate for new connections. Input if they are unusable, or if it would turn tokens or
    // TLS on or off; the old ones stay then. Do not call on the io thread.
    virtual Result<void> setCredentials(const Credentials& credentials) = 0;

    [[nodiscard]] virtual const Counters& counters() const = 0;
};

// Binds the port and starts the io thread. Uses TLS if there is a certificate. Errors: see Listener::open().
Result<std::unique_ptr<Server>> startServer(const Options& options, Handlers handlers);

}  // namespace spherule::net

#pragma once

#include <chrono>
#include <optional>

#include "net/tcp_progress.h"

namespace spherule::net {

// The timeouts of one session. The session reports events and calls check(); there is no socket here. Used by one
// thread.
//
// Beast's own idle timeout is not used. Its ping waits behind the message being written, so a large frame that is read
// slowly but steadily would end a healthy session.
class SessionTimeouts {
  public:
    using Clock = std::chrono::steady_clock;
    using Duration = std::chrono::milliseconds;

    struct Limits {
        Duration hello;     // until the client's first message
        Duration progress;  // for a write or the closing handshake to advance
        Duration idle;      // without data from the peer
    };

    enum class Verdict {
        Fine,
        Ping,     // send a ping: the peer was silent for half the idle time
        NoHello,  // close the session
        Stalled,  // drop the session: a write made no progress
        Silent,   // drop the session
    };

    SessionTimeouts(const Limits& limits, Clock::time_point now);

    void helloReceived() { helloDone_ = true; }
    void writeBegan(Clock::time_point now);
    void writeEnded() { writing_ = false; }
    void closeBegan(Clock::time_point now) { closeBegan_ = now; }

    // Call every interval(), with the current counts of the socket.
    Verdict check(const TcpProgress& progress, Clock::time_point now);
    [[nodiscard]] Duration interval() const;

  private:
    Limits limits_;
    TcpProgress seen_;
    Clock::time_point began_;
    Clock::time_point alive_;     // last data or confirmation from the peer
    Clock::time_point advanced_;  // last progress of the current write
    std::optional<Clock::time_point> closeBegan_;
    bool helloDone_ = false;
    bool writing_ = false;
    bool pinged_ = false;
};

}  // namespace spherule::net

#pragma once

#include <chrono>
#include <optional>

#include "net/tcp_progress.h"

namespace spherule::net {

// The clock rules of one session, told what happened and asked what to do; knows no sockets. One thread.
//
// Beast's own idle timeout is not used: its ping waits behind the message being written, so that a large frame which is
// read slowly but steadily would end a healthy session.
class SessionTimeouts {
  public:
    using Clock = std::chrono::steady_clock;
    using Duration = std::chrono::milliseconds;

    struct Limits {
        Duration hello;     // from the start to the client's first message
        Duration progress;  // of a write, and of the closing handshake
        Duration idle;      // without a sign of life
    };

    enum class Verdict {
        Fine,
        Ping,     // silent for half the idle time: ask
        NoHello,  // close
        Stalled,  // drop
        Silent,   // drop
    };

    SessionTimeouts(const Limits& limits, Clock::time_point now);

    void helloReceived() { helloDone_ = true; }
    void writeBegan(Clock::time_point now);
    void writeEnded() { writing_ = false; }
    void closeBegan(Clock::time_point now) { closeBegan_ = now; }

    // To be called every `interval()`.
    Verdict check(const TcpProgress& progress, Clock::time_point now);
    [[nodiscard]] Duration interval() const;

  private:
    Limits limits_;
    TcpProgress seen_;
    Clock::time_point began_;
    Clock::time_point alive_;     // last sign of life
    Clock::time_point advanced_;  // last progress of the write under way
    std::optional<Clock::time_point> closeBegan_;
    bool helloDone_ = false;
    bool writing_ = false;
    bool pinged_ = false;
};

}  // namespace spherule::net

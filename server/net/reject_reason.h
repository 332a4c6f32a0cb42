#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace spherule::net {

// Why something from outside was turned away. In the order of the names below, which metrics and logs use.
enum class RejectReason : std::uint8_t {
    // Connections, closed without an answer.
    Connections,     // as many are open as may be
    Accept,          // by the system: mostly, no descriptor was left
    ConnectionRate,  // of this address, too many in a second
    Fault,           // it could not be served, for lack of memory or by a fault of the server
    Tls,             // no TLS, or none that is good enough
    // Requests.
    SlowRequest,  // it did not come in time
    Malformed,    // not HTTP
    LongHeader,
    LongBody,
    BadRequest,  // a method or a target that is not answered
    Host,        // a name that is not this server's
    NoToken,
    WrongToken,
    // Handshakes of the stream.
    Origin,  // a page of another site
    Subprotocol,
    Handshake,           // not WebSocket
    NotReady,            // the scene is still being made
    Sessions,            // as many are open as may be
    SessionsPerAddress,  // the same, of this address
    // Commands.
    UnknownCommand,
    CommandRate,
    CommandQueue,
    CommandCost,   // it would take too much memory
    UnfitCommand,  // a field that is not known, or a value that is not one of the field
    ViewersCommand,
    ControlsHeld,  // by somebody else
};

constexpr std::array<std::string_view, 26> rejectReasonNames = {"connections",
                                                                "accept",
                                                                "connection_rate",
                                                                "fault",
                                                                "tls",
                                                                "slow_request",
                                                                "malformed",
                                                                "long_header",
                                                                "long_body",
                                                                "bad_request",
                                                                "host",
                                                                "no_token",
                                                                "wrong_token",
                                                                "origin",
                                                                "subprotocol",
                                                                "handshake",
                                                                "not_ready",
                                                                "sessions",
                                                                "sessions_per_address",
                                                                "unknown_command",
                                                                "command_rate",
                                                                "command_queue",
                                                                "command_cost",
                                                                "unfit_command",
                                                                "viewers_command",
                                                                "controls_held"};

constexpr std::string_view nameOf(RejectReason cause) {
    return rejectReasonNames[static_cast<std::size_t>(cause)];
}

}  // namespace spherule::net

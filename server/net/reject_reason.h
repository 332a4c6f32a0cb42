#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace spherule::net {

// Why a connection, a request or a command was rejected. Metrics and logs use the names below, in the same order.
enum class RejectReason : std::uint8_t {
    // Connections, closed without an answer.
    Connections,     // limit of open connections
    Accept,          // accept() failed, usually for lack of file descriptors
    ConnectionRate,  // too many from this address within a second
    Fault,           // out of memory, or an internal error
    Tls,             // handshake failed
    // Requests.
    SlowRequest,  // not received in time
    Malformed,    // not HTTP
    LongHeader,
    LongBody,
    BadRequest,  // unsupported method or target
    Host,        // unknown name in the Host header
    NoToken,
    WrongToken,
    // Handshakes of the stream.
    Origin,  // page of another site
    Subprotocol,
    Handshake,           // not WebSocket
    NotReady,            // the scene is not ready
    Sessions,            // limit of sessions
    SessionsPerAddress,  // limit of sessions of this address
    // Commands.
    UnknownCommand,
    CommandRate,
    CommandQueue,
    CommandCost,   // needs too much memory
    UnfitCommand,  // unknown field or invalid value
    ViewersCommand,
    ControlHeld,  // by another session
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
                                                                "control_held"};

constexpr std::string_view nameOf(RejectReason cause) {
    return rejectReasonNames[static_cast<std::size_t>(cause)];
}

}  // namespace spherule::net

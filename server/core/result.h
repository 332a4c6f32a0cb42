#pragma once

#include <optional>
#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace spherule {

// The kind of an error determines the exit code of a command (see cli/exit_codes.h).
enum class ErrorKind {
    Input,       // invalid scene, command line, file or message
    NoDevice,    // no compute device
    Refused,     // valid, but not possible now
    DeviceLost,  // the compute device is lost
    Diverged,    // a simulation has become non-finite
    Cancelled,   // cancelled by the user
};

// Why a command is refused, for programs. As Refused.Cause in control.proto, in the same order.
enum class Cause {
    Unspecified,
    Range,
    NoRoom,
    TooLarge,
    NoMemory,
    Busy,
    Ended,
    Cancelled,
    TooManyCommands,
    NotAllowed,
    ControlHeld,
    NoSuchSphere,
    NoHit,
    FixedSphere,
    NoSuchScene,
    NotSuited,
    TooManySubsteps,
    NonFinite,
    Playback,
    NoRecordings,
    RecordingAlready,
    NotRecording,
    RecordingsFull,
    NothingToCancel,
    Unfit,
    Stopping,
    NoCheckpoints,
};

// The limits of a refused value, in its unit; absent: unknown.
struct Limits {
    std::optional<double> least;
    std::optional<double> most;
};

struct Error {
    ErrorKind kind = ErrorKind::Input;
    std::string where;    // file, field path or resource; may be empty
    std::string message;  // the problem with the offending value, and how to fix it
    Cause cause = Cause::Unspecified;
    Limits limits{};

    [[nodiscard]] std::string text() const { return where.empty() ? message : where + ": " + message; }
};

template <class T>
using Result = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> fail(ErrorKind kind, std::string where, std::string message,
                                                Cause cause = Cause::Unspecified, Limits limits = {}) {
    return tl::unexpected<Error>(Error{kind, std::move(where), std::move(message), cause, limits});
}

}  // namespace spherule

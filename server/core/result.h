#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace spherule {

// What went wrong decides the exit code of a command (see app/exit_codes.h).
enum class ErrorKind {
    Input,       // a scene, a command line or a message that cannot be accepted
    NoDevice,    // nothing to compute on
    Refused,     // understood, but not possible now
    DeviceLost,  // the compute device is gone
    Diverged,    // a simulation has left the numbers
    Cancelled,   // somebody asked for it to end
};

struct Error {
    ErrorKind kind = ErrorKind::Input;
    std::string where;    // file, field path or resource; may be empty
    std::string message;  // what is wrong, with the offending value, and what to do

    [[nodiscard]] std::string text() const { return where.empty() ? message : where + ": " + message; }
};

template <class T>
using Result = tl::expected<T, Error>;

[[nodiscard]] inline tl::unexpected<Error> fail(ErrorKind kind, std::string where, std::string message) {
    return tl::unexpected<Error>(Error{kind, std::move(where), std::move(message)});
}

}  // namespace spherule

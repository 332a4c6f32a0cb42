#pragma once

#include <string_view>

#include "core/result.h"
#include "spherule/v1/control.pb.h"

namespace spherule::net {

// Encoding of a message: protobuf in binary WebSocket frames, or JSON in text frames.
enum class Encoding { Binary, Text };

// Decodes one WebSocket message of a client. Any thread. Errors: Input if the bytes are no message; Refused if they are
// JSON with an unknown field or an invalid value, whose path is `where`. The path of a field of a command begins at the
// Command. In protobuf, unknown fields are skipped. In JSON, bare NaN and Infinity are read as numbers. A number out of
// the range of double is invalid.
Result<v1::ClientMessage> decodeClientMessage(std::string_view bytes, Encoding encoding);

}  // namespace spherule::net

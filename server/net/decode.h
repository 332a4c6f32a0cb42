#pragma once

#include <string_view>

#include "core/result.h"
#include "spherule/v1/control.pb.h"

namespace spherule::net {

// How a message travels: protobuf in binary frames, or its JSON form in text frames.
enum class Encoding { Binary, Text };

// One WebSocket message of a client. An error of kind Input: the bytes are no message. Of kind Refused: they are JSON,
// and the field `where` is not known or its value does not fit; the path begins at the Command where it is in one.
// Protobuf skips fields that are not known. NaN and infinities as bare words, which JSON has not, are read as numbers;
// a number beyond a double does not fit.
Result<v1::ClientMessage> decodeClientMessage(std::string_view bytes, Encoding encoding);

}  // namespace spherule::net

#pragma once

#include <string_view>

#include "core/result.h"
#include "spherule/v1/control.pb.h"

namespace spherule::net {

// How a message travels: protobuf in binary frames, or its JSON form in text frames.
enum class Encoding { Binary, Text };

// One WebSocket message of a client. A text with a field that is not known is an error; protobuf skips such fields.
Result<v1::ClientMessage> decodeClientMessage(std::string_view bytes, Encoding encoding);

}  // namespace spherule::net

#include "codec/message.h"

#include <stdexcept>
#include <utility>

#include <google/protobuf/util/json_util.h>

namespace spherule::codec {

Message::Message(v1::ServerMessage message) : message_(std::move(message)), binary_(message_.SerializeAsString()) {}

const std::string& Message::json() const {
    std::call_once(jsonMade_, [this] {
        const auto status = google::protobuf::util::MessageToJsonString(message_, &json_);
        // Only a string that is not UTF-8 fails, and all strings are checked when they enter the program.
        if (!status.ok()) throw std::logic_error("a server message has no JSON form: " + status.ToString());
    });
    return json_;
}

}  // namespace spherule::codec

#include "net/decode.h"

#include <string>

#include <google/protobuf/util/json_util.h>

namespace spherule::net {

Result<v1::ClientMessage> decodeClientMessage(std::string_view bytes, Encoding encoding) {
    v1::ClientMessage message;
    if (encoding == Encoding::Text) {
        const auto status = google::protobuf::util::JsonStringToMessage({bytes.data(), bytes.size()}, &message);
        if (!status.ok()) {
            return fail(ErrorKind::Input, "", "not the JSON form of a ClientMessage: " + std::string(status.message()));
        }
    } else if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
        return fail(ErrorKind::Input, "", "not a ClientMessage of spherule.v1");
    }
    return message;
}

}  // namespace spherule::net

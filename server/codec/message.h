#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "spherule/v1/control.pb.h"

namespace spherule::codec {

// One message to any number of clients: serialised once, shared, immutable. Any thread.
class Message {
  public:
    explicit Message(v1::ServerMessage message);

    [[nodiscard]] const v1::ServerMessage& content() const { return message_; }
    [[nodiscard]] const std::string& binary() const { return binary_; }
    // JSON form; created by the first call.
    [[nodiscard]] const std::string& json() const;

  private:
    const v1::ServerMessage message_;
    const std::string binary_;
    mutable std::once_flag jsonMade_;
    mutable std::string json_;
};

using SharedMessage = std::shared_ptr<const Message>;

inline SharedMessage share(v1::ServerMessage message) {
    return std::make_shared<const Message>(std::move(message));
}

}  // namespace spherule::codec

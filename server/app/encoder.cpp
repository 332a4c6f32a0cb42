#include "app/encoder.h"

#include "frame/wire.h"

namespace spherule::app {

Encoder::Encoder(std::function<void(frame::SharedMessage)> publish)
    : thread_([this, publish = std::move(publish)] {
          while (auto state = slot_.take()) {
              v1::ServerMessage message;
              *message.mutable_frame() = std::move(state->head);
              *message.mutable_frame()->mutable_states() = frame::statesOf(state->bytes);
              publish(std::make_shared<const frame::Message>(std::move(message)));
          }
      }) {}

Encoder::~Encoder() {
    slot_.close();
    thread_.join();
}

}  // namespace spherule::app

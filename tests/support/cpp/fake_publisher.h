#pragma once

#include <cstdint>
#include <vector>

#include "net/publisher.h"

namespace spherule {

// A publisher without sessions. Tests override what they look at.
class FakePublisher : public net::Publisher {
  public:
    void retain(codec::SharedMessage, codec::Audience) override {}
    void setOrder(codec::SharedMessage, codec::Audience) override {}
    void follow(codec::SharedMessage) override {}
    void refreshScene(codec::SharedMessage) override {}
    void publish(const codec::EncodedFrame&) override {}
    void broadcast(codec::SharedMessage) override {}
    void announce(net::SessionId, v1::Event) override {}
    void reply(net::SessionId, v1::CommandResult) override {}
    [[nodiscard]] std::uint32_t viewers() const override { return 0; }
    [[nodiscard]] std::vector<codec::Subscription> subscriptions() override { return {}; }
};

}  // namespace spherule

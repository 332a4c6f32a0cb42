#include "codec/message.h"

#include <gtest/gtest.h>

namespace spherule::codec {
namespace {

v1::ServerMessage stateMessage() {
    v1::ServerMessage message;
    message.mutable_frame()->set_sim_time(0.5);
    message.mutable_frame()->set_spb(std::string("\x01\x02\xff", 3));
    return message;
}

TEST(Message, SerialisesToBinary) {
    const Message message(stateMessage());
    v1::ServerMessage parsed;
    ASSERT_TRUE(parsed.ParseFromString(message.binary()));
    EXPECT_EQ(parsed.SerializeAsString(), stateMessage().SerializeAsString());
}

TEST(Message, SerialisesToJson) {
    EXPECT_EQ(Message(stateMessage()).json(), R"({"frame":{"simTime":0.5,"spb":"AQL/"}})");
}

}  // namespace
}  // namespace spherule::codec

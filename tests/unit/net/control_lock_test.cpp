#include "net/control_lock.h"

#include <gtest/gtest.h>

namespace spherule::net {
namespace {

class ControlLockTest : public testing::Test {
  protected:
    std::uint64_t holder() const { return lock_.state().holder().session(); }
    std::vector<std::uint64_t> asking() const {
        std::vector<std::uint64_t> row;
        for (const auto& person : lock_.state().asking()) row.push_back(person.session());
        return row;
    }

    int told_ = 0;
    ControlLock lock_{[this](const v1::Control&) { ++told_; }};
};

using Row = std::vector<std::uint64_t>;

TEST_F(ControlLockTest, IsAcquiredByTheFirstCommand) {
    EXPECT_TRUE(lock_.acquire(1, "one"));
    EXPECT_TRUE(lock_.acquire(1, "one"));
    EXPECT_FALSE(lock_.acquire(2, "two"));
    EXPECT_EQ(holder(), 1U);
    EXPECT_EQ(lock_.state().holder().client(), "one");
    EXPECT_EQ(told_, 1);
}

TEST_F(ControlLockTest, IsPassedOnOnlyByItsHolder) {
    lock_.acquire(1, "one");
    lock_.request(2, "two");
    lock_.request(2, "two");
    lock_.request(3, "three");
    EXPECT_EQ(asking(), (Row{2, 3}));
    lock_.release(4, 3);  // not the holder
    lock_.denyRequests(3);
    EXPECT_EQ(holder(), 1U);
    lock_.release(1, 3);
    EXPECT_EQ(holder(), 3U);
    EXPECT_EQ(asking(), (Row{2}));
}

TEST_F(ControlLockTest, StaysWhenTheHolderDeniesRequests) {
    lock_.acquire(1, "one");
    lock_.request(2, "two");
    lock_.release(1, 9);  // has not requested the lock
    EXPECT_EQ(holder(), 1U);
    lock_.denyRequests(1);
    EXPECT_EQ(asking(), Row{});
    EXPECT_EQ(holder(), 1U);
}

TEST_F(ControlLockTest, GoesToTheOldestRequestWhenTheHolderLeaves) {
    lock_.acquire(1, "one");
    lock_.request(2, "two");
    lock_.request(3, "three");
    lock_.onSessionEnded(2);
    EXPECT_EQ(asking(), (Row{3}));
    lock_.onSessionEnded(1);
    EXPECT_EQ(holder(), 3U);
    lock_.onSessionEnded(3);
    EXPECT_FALSE(lock_.state().has_holder());
    EXPECT_TRUE(lock_.acquire(4, "four"));
}

TEST_F(ControlLockTest, RequestCanBeWithdrawn) {
    lock_.acquire(1, "one");
    lock_.request(2, "two");
    lock_.release(2, 0);
    EXPECT_EQ(asking(), Row{});
    EXPECT_EQ(holder(), 1U);
    lock_.release(1, 0);
    EXPECT_FALSE(lock_.state().has_holder());
}

TEST_F(ControlLockTest, LimitsRequests) {
    lock_.acquire(1, "one");
    for (std::uint64_t id = 2; id < 100; ++id) lock_.request(id, "many");
    EXPECT_EQ(asking().size(), 16U);
}

}  // namespace
}  // namespace spherule::net

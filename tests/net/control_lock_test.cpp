#include "net/control_lock.h"

#include <gtest/gtest.h>

namespace spherule::net {
namespace {

class Controls : public testing::Test {
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

TEST_F(Controls, GoToWhoGivesACommandFirst) {
    EXPECT_TRUE(lock_.acquire(1, "one"));
    EXPECT_TRUE(lock_.acquire(1, "one"));
    EXPECT_FALSE(lock_.acquire(2, "two"));
    EXPECT_EQ(holder(), 1U);
    EXPECT_EQ(lock_.state().holder().client(), "one");
    EXPECT_EQ(told_, 1);
}

TEST_F(Controls, AreHandedOverByTheirHolderAlone) {
    lock_.acquire(1, "one");
    lock_.request(2, "two");
    lock_.request(2, "two");
    lock_.request(3, "three");
    EXPECT_EQ(asking(), (Row{2, 3}));
    lock_.release(4, 3);  // who has nothing to give
    lock_.denyRequests(3);
    EXPECT_EQ(holder(), 1U);
    lock_.release(1, 3);
    EXPECT_EQ(holder(), 3U);
    EXPECT_EQ(asking(), (Row{2}));
}

TEST_F(Controls, StayWithTheirHolderWhoKeepsThem) {
    lock_.acquire(1, "one");
    lock_.request(2, "two");
    lock_.release(1, 9);  // who does not ask
    EXPECT_EQ(holder(), 1U);
    lock_.denyRequests(1);
    EXPECT_EQ(asking(), Row{});
    EXPECT_EQ(holder(), 1U);
}

TEST_F(Controls, GoToWhoAskedFirstWhenTheirHolderLeaves) {
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

TEST_F(Controls, AreWithdrawnFromByWhoAsks) {
    lock_.acquire(1, "one");
    lock_.request(2, "two");
    lock_.release(2, 0);
    EXPECT_EQ(asking(), Row{});
    EXPECT_EQ(holder(), 1U);
    lock_.release(1, 0);
    EXPECT_FALSE(lock_.state().has_holder());
}

TEST_F(Controls, AreAskedForByAFewAtATime) {
    lock_.acquire(1, "one");
    for (std::uint64_t id = 2; id < 100; ++id) lock_.request(id, "many");
    EXPECT_EQ(asking().size(), 16U);
}

}  // namespace
}  // namespace spherule::net

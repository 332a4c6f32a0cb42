#include "net/lease.h"

#include <gtest/gtest.h>

namespace spherule::net {
namespace {

class Controls : public testing::Test {
  protected:
    std::uint64_t holder() const { return lease_.state().holder().session(); }
    std::vector<std::uint64_t> asking() const {
        std::vector<std::uint64_t> row;
        for (const auto& person : lease_.state().asking()) row.push_back(person.session());
        return row;
    }

    int told_ = 0;
    Lease lease_{[this](const v1::Control&) { ++told_; }};
};

using Row = std::vector<std::uint64_t>;

TEST_F(Controls, GoToWhoGivesACommandFirst) {
    EXPECT_TRUE(lease_.take(1, "one"));
    EXPECT_TRUE(lease_.take(1, "one"));
    EXPECT_FALSE(lease_.take(2, "two"));
    EXPECT_EQ(holder(), 1U);
    EXPECT_EQ(lease_.state().holder().client(), "one");
    EXPECT_EQ(told_, 1);
}

TEST_F(Controls, AreHandedOverByTheirHolderAlone) {
    lease_.take(1, "one");
    lease_.ask(2, "two");
    lease_.ask(2, "two");
    lease_.ask(3, "three");
    EXPECT_EQ(asking(), (Row{2, 3}));
    lease_.yield(4, 3);  // who has nothing to give
    lease_.retain(3);
    EXPECT_EQ(holder(), 1U);
    lease_.yield(1, 3);
    EXPECT_EQ(holder(), 3U);
    EXPECT_EQ(asking(), (Row{2}));
}

TEST_F(Controls, StayWithTheirHolderWhoKeepsThem) {
    lease_.take(1, "one");
    lease_.ask(2, "two");
    lease_.yield(1, 9);  // who does not ask
    EXPECT_EQ(holder(), 1U);
    lease_.retain(1);
    EXPECT_EQ(asking(), Row{});
    EXPECT_EQ(holder(), 1U);
}

TEST_F(Controls, GoToWhoAskedFirstWhenTheirHolderLeaves) {
    lease_.take(1, "one");
    lease_.ask(2, "two");
    lease_.ask(3, "three");
    lease_.left(2);
    EXPECT_EQ(asking(), (Row{3}));
    lease_.left(1);
    EXPECT_EQ(holder(), 3U);
    lease_.left(3);
    EXPECT_FALSE(lease_.state().has_holder());
    EXPECT_TRUE(lease_.take(4, "four"));
}

TEST_F(Controls, AreWithdrawnFromByWhoAsks) {
    lease_.take(1, "one");
    lease_.ask(2, "two");
    lease_.yield(2, 0);
    EXPECT_EQ(asking(), Row{});
    EXPECT_EQ(holder(), 1U);
    lease_.yield(1, 0);
    EXPECT_FALSE(lease_.state().has_holder());
}

TEST_F(Controls, AreAskedForByAFewAtATime) {
    lease_.take(1, "one");
    for (std::uint64_t id = 2; id < 100; ++id) lease_.ask(id, "many");
    EXPECT_EQ(asking().size(), 16U);
}

}  // namespace
}  // namespace spherule::net

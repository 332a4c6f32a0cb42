#include <algorithm>
#include <numeric>

#include "device_fixture.h"

namespace spherule::compute {
namespace {

TEST_F(DeviceTest, NewBufferIsZero) {
    const auto fresh = buffer(4000);
    EXPECT_EQ(fresh->bytes(), 4000U);
    EXPECT_EQ(contents(*fresh), std::vector<std::uint32_t>(1000, 0));
}

TEST_F(DeviceTest, NewBufferIsZeroInReusedMemory) {
    for (int round = 0; round < 20; ++round) {
        const auto reused = buffer(1 << 14);
        EXPECT_EQ(contents(*reused), std::vector<std::uint32_t>(1 << 12, 0));
        device_->fill(*reused, 0xdeadbeef);
    }
}

TEST_F(DeviceTest, DownloadReturnsUploadedBytes) {
    std::vector<std::uint32_t> values(1001);
    std::iota(values.begin(), values.end(), 7U);
    const auto filled = buffer(values);
    EXPECT_EQ(contents(*filled), values);
}

TEST_F(DeviceTest, UploadAndDownloadAccessOnlyTheirRange) {
    const auto target = buffer(std::vector<std::uint32_t>{1, 2, 3, 4});
    const std::vector<std::uint32_t> middle{20, 30};
    device_->upload(*target, 4, std::as_bytes(std::span(middle)));
    EXPECT_EQ(contents(*target), (std::vector<std::uint32_t>{1, 20, 30, 4}));
    std::uint32_t last = 0;
    device_->download(*target, 12, std::as_writable_bytes(std::span(&last, 1)));
    EXPECT_EQ(last, 4U);
}

TEST_F(DeviceTest, CopyMovesOnlyItsRangeAfterEarlierWritesAndBeforeLaterOnes) {
    const auto from = buffer(std::vector<std::uint32_t>{1, 2, 3, 4});
    const auto to = buffer(std::vector<std::uint32_t>{5, 6, 7, 8});
    device_->copy(*from, 4, 8, *to, 8);
    device_->fill(*from, 9);
    EXPECT_EQ(contents(*to), (std::vector<std::uint32_t>{5, 6, 2, 3}));
}

TEST_F(DeviceTest, DownloadLargerThanOneChunkIsComplete) {
    std::vector<std::uint32_t> values(std::size_t{10} << 20U);
    std::iota(values.begin(), values.end(), 0U);
    EXPECT_EQ(contents(*buffer(values)), values);
}

// Uploads that the device has not read yet are kept, whatever their sizes and places.
TEST_F(DeviceTest, ManyUploadsArriveInTheirOrder) {
    std::vector<std::uint8_t> expected(std::size_t{5} << 20U);
    const auto target = buffer(expected.size());
    std::uint32_t state = 1;
    const auto next = [&state](std::size_t below) {
        state = state * 1664525U + 1013904223U;
        return (state >> 4U) % below;
    };
    for (int round = 0; round < 30; ++round) {
        const std::size_t offset = next(expected.size() / 2);
        const std::vector<std::uint8_t> bytes(1 + next(expected.size() / 2), static_cast<std::uint8_t>(round + 1));
        device_->upload(*target, offset, std::as_bytes(std::span(bytes)));
        std::ranges::copy(bytes, expected.begin() + static_cast<std::ptrdiff_t>(offset));
    }
    std::vector<std::uint8_t> found(expected.size());
    device_->download(*target, 0, std::as_writable_bytes(std::span(found)));
    EXPECT_TRUE(found == expected);
}

TEST_F(DeviceTest, FillSetsEveryWord) {
    const auto target = buffer(400);
    device_->fill(*target, 0x01020304);
    EXPECT_EQ(contents(*target), std::vector<std::uint32_t>(100, 0x01020304));
}

TEST_F(DeviceTest, EmptyBufferIsAllowed) {
    const auto empty = buffer(std::size_t{0});
    EXPECT_EQ(empty->bytes(), 0U);
    EXPECT_TRUE(contents(*empty).empty());
}

TEST_F(DeviceTest, BufferBeyondTheLimitIsRefusedWithBothSizes) {
    const auto limit = device_->info().maxBufferBytes;
    const auto refused = device_->createBuffer("positions", limit + 1);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().kind, ErrorKind::Refused);
    EXPECT_EQ(refused.error().where, "positions");
    for (const auto bytes : {limit, limit + 1})
        EXPECT_NE(refused.error().message.find(std::to_string(bytes)), std::string::npos) << refused.error().text();
}

TEST_F(DeviceTest, BuffersMayOutliveTheDevice) {
    const auto survivor = buffer(64);
    device_.reset();
    device_ = openTestDevice();
    EXPECT_EQ(contents(*buffer(64)), std::vector<std::uint32_t>(16, 0));
}

TEST_F(DeviceTest, TwoDevicesOnOneThreadAreIndependent) {
    const auto mine = buffer(std::vector<std::uint32_t>{1});
    const auto other = openTestDevice();
    const auto theirs = other->createBuffer("other", 4).value();
    other->fill(*theirs, 5);
    device_->fill(*mine, 6);
    std::uint32_t value = 0;
    other->download(*theirs, 0, std::as_writable_bytes(std::span(&value, 1)));
    EXPECT_EQ(value, 5U);
    EXPECT_EQ(contents(*mine), std::vector<std::uint32_t>{6});
}

}  // namespace
}  // namespace spherule::compute

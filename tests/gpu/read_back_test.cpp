#include <algorithm>
#include <chrono>
#include <thread>

#include "device_fixture.h"

namespace spherule::compute {
namespace {

std::vector<std::byte> waitFor(ReadBack& copy) {
    for (int i = 0; i < 20000; ++i) {
        if (const auto bytes = copy.poll()) return {bytes->begin(), bytes->end()};
        std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
    throw std::runtime_error("the read-back never arrived");
}

std::vector<std::byte> bytesOf(const std::vector<std::uint32_t>& values) {
    const auto bytes = std::as_bytes(std::span(values));
    return {bytes.begin(), bytes.end()};
}

TEST_F(DeviceTest, ReadBackReturnsTheResultOfALaunch) {
    const auto square = kernel(R"(
        layout(std430, binding = 0) buffer Values { uint values[]; };
        void main() { uint i = self(); if (i < invocations) values[i] = i * i; })");
    const auto values = buffer(16);
    launch(*square, 4, {values.get()});
    const auto copy = device_->startReadBack(*values, 12);
    ASSERT_NE(copy, nullptr);
    EXPECT_EQ(waitFor(*copy), bytesOf({0, 1, 4}));
}

TEST_F(DeviceTest, AtMostTwoReadBacksAreActive) {
    const auto values = buffer(std::vector<std::uint32_t>{1, 2});
    auto first = device_->startReadBack(*values, 8);
    device_->fill(*values, 9);
    const auto second = device_->startReadBack(*values, 8);
    device_->fill(*values, 11);
    ASSERT_NE(first, nullptr);
    ASSERT_NE(second, nullptr);
    EXPECT_EQ(device_->startReadBack(*values, 8), nullptr);
    EXPECT_EQ(waitFor(*second), bytesOf({9, 9}));
    EXPECT_EQ(waitFor(*first), bytesOf({1, 2}));
    first.reset();
    const auto third = device_->startReadBack(*values, 8);
    ASSERT_NE(third, nullptr);
    EXPECT_EQ(waitFor(*third), bytesOf({11, 11}));
    EXPECT_EQ(waitFor(*second), bytesOf({9, 9}));
}

TEST_F(DeviceTest, ReadBackSupportsBuffersOfAnySize) {
    for (const std::size_t words : {std::size_t{4}, std::size_t{1} << 20U, std::size_t{16}}) {
        const auto values = buffer(std::vector<std::uint32_t>(words, 3));
        const auto copy = device_->startReadBack(*values, words * 4);
        ASSERT_NE(copy, nullptr);
        EXPECT_EQ(waitFor(*copy), bytesOf(std::vector<std::uint32_t>(words, 3)));
    }
}

TEST_F(DeviceTest, ReadBackMayOutliveTheDevice) {
    const auto values = buffer(std::vector<std::uint32_t>{5});
    const auto copy = device_->startReadBack(*values, 4);
    device_.reset();
    EXPECT_EQ(waitFor(*copy), bytesOf({5}));
    device_ = openTestDevice();
}

}  // namespace
}  // namespace spherule::compute

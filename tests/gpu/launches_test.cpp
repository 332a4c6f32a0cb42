#include <array>

#include "device_fixture.h"

namespace spherule::compute {
namespace {

constexpr const char* countUp = R"(
    layout(std430, binding = 0) buffer Values { uint values[]; };
    void main() { uint i = self(); if (i < invocations) values[i] += i + 1u; })";

TEST_F(DeviceTest, EveryInvocationRunsOnceForAnyCount) {
    const auto up = kernel(countUp);
    for (const std::uint32_t count : {1U, 63U, 64U, 65U, 1000U}) {
        const auto values = buffer((count + 1) * 4);
        launch(*up, count, {values.get()});
        const auto got = contents(*values);
        for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(got[i], i + 1) << count;
        EXPECT_EQ(got[count], 0U);
    }
}

TEST_F(DeviceTest, LaunchWithCountZeroDoesNothing) {
    const auto up = kernel(countUp);
    const auto values = buffer(4);
    launch(*up, 0, {values.get()});
    EXPECT_EQ(contents(*values), std::vector<std::uint32_t>{0});
}

TEST_F(DeviceTest, EveryInvocationRunsOnceBeyondOneRowOfGroups) {
    constexpr std::uint32_t count = 32768 * 64 + 777;
    const auto up = kernel(countUp);
    const auto values = buffer(count * 4);
    launch(*up, count, {values.get()});
    const auto got = contents(*values);
    std::uint32_t wrong = 0;
    for (std::uint32_t i = 0; i < count; ++i) wrong += got[i] == i + 1 ? 0 : 1;
    EXPECT_EQ(wrong, 0U);
}

TEST_F(DeviceTest, LaunchReadsTheResultOfThePreviousLaunch) {
    const auto shift = kernel(R"(
        layout(std430, binding = 0) buffer From { uint from[]; };
        layout(std430, binding = 1) buffer To { uint to[]; };
        void main() { uint i = self(); if (i < invocations) to[i] = from[(i + 1u) % invocations] + 1u; })");
    constexpr std::uint32_t count = 1000;
    auto a = buffer(count * 4);
    auto b = buffer(count * 4);
    for (int round = 0; round < 50; ++round) {
        launch(*shift, count, {a.get(), b.get()});
        std::swap(a, b);
    }
    EXPECT_EQ(contents(*a), std::vector<std::uint32_t>(count, 50));
}

TEST_F(DeviceTest, PhaseChangesBetweenLaunches) {
    const auto mark = kernel(R"(
        layout(std430, binding = 0) buffer Values { uint values[]; };
        void main() { if (self() < invocations) values[phase] = invocations; })");
    const auto values = buffer(12);
    for (const std::uint32_t phase : {2U, 0U, 1U}) launch(*mark, 10 + phase, {values.get()}, phase);
    EXPECT_EQ(contents(*values), (std::vector<std::uint32_t>{10, 11, 12}));
}

TEST_F(DeviceTest, IndirectLaunchReadsItsCountFromABuffer) {
    const auto plan = kernel(R"(
        layout(std430, binding = 0) buffer Arguments { uint arguments[]; };
        void main() {
            if (self() > 0u) return;
            uint count = 130u;
            arguments[4] = (count + 63u) / 64u; arguments[5] = 1u; arguments[6] = 1u; arguments[7] = count;
        })");
    const auto work = kernel(R"(
        layout(std430, binding = 0) buffer Values { uint values[]; };
        layout(std430, binding = 1) buffer Arguments { uint arguments[]; };
        void main() {
            uint i = self();
            if (i < arguments[7]) values[i] += invocations == 0xffffffffu ? 1u : 100u;
            if (i == 0u) values[150] = phase;
        })");
    const auto arguments = buffer(32);
    const auto values = buffer(151 * 4);
    launch(*plan, 1, {arguments.get()});
    const std::array<Buffer*, 2> buffers{values.get(), arguments.get()};
    Launch indirect;
    indirect.kernel = work.get();
    indirect.buffers = buffers;
    indirect.arguments = arguments.get();
    indirect.argumentsOffset = 16;
    indirect.phase = 4;
    device_->launch(indirect);

    std::vector<std::uint32_t> expected(151, 0);
    std::fill_n(expected.begin(), 130, 1U);
    expected[150] = 4;
    EXPECT_EQ(contents(*values), expected);
}

// An indirect launch reads what the one before it has written to the arguments of both.
TEST_F(DeviceTest, IndirectLaunchMayChangeItsArgumentsForTheNextOne) {
    const auto next = kernel(R"(
        layout(std430, binding = 0) buffer Values { uint values[]; };
        layout(std430, binding = 1) buffer Arguments { uint arguments[]; };
        void main() {
            atomicAdd(values[phase], 1u);
            if (self() == 0u) arguments[0] = gl_NumWorkGroups.x + 3u;
        })");
    const auto arguments = buffer(std::vector<std::uint32_t>{1, 1, 1, 64});
    const auto values = buffer(20 * 4);
    const std::array<Buffer*, 2> buffers{values.get(), arguments.get()};
    Launch indirect;
    indirect.kernel = next.get();
    indirect.buffers = buffers;
    indirect.arguments = arguments.get();
    std::vector<std::uint32_t> expected;
    for (std::uint32_t phase = 0; phase < 20; ++phase) {
        indirect.phase = phase;
        device_->launch(indirect);
        expected.push_back(64 * (1 + 3 * phase));
    }
    EXPECT_EQ(contents(*values), expected);
}

TEST_F(DeviceTest, IndirectLaunchWithoutGroupsDoesNothing) {
    const auto work = kernel(R"(
        layout(std430, binding = 0) buffer Values { uint values[]; };
        void main() { values[0] = 1u; })");
    const auto arguments = buffer(std::vector<std::uint32_t>{0, 1, 1, 0});
    const auto values = buffer(4);
    const std::array<Buffer*, 1> buffers{values.get()};
    Launch indirect;
    indirect.kernel = work.get();
    indirect.buffers = buffers;
    indirect.arguments = arguments.get();
    device_->launch(indirect);
    EXPECT_EQ(contents(*values), std::vector<std::uint32_t>{0});
}

TEST_F(DeviceTest, NewBufferTakesBindingOfDeletedBuffer) {
    const auto up = kernel(countUp);
    for (int round = 0; round < 10; ++round) {
        const auto values = buffer(8);
        launch(*up, 2, {values.get()});
        ASSERT_EQ(contents(*values), (std::vector<std::uint32_t>{1, 2}));
    }
}

TEST_F(DeviceTest, NewKernelRunsAfterDeletedKernel) {
    for (std::uint32_t round = 1; round < 10; ++round) {
        const std::array defines{Define{"VALUE", std::to_string(round) + "u"}};
        const auto set = kernel(R"(
            layout(std430, binding = 0) buffer Values { uint values[]; };
            void main() { if (self() == 0u) values[0] = VALUE + invocations; })",
                                defines);
        const auto values = buffer(4);
        launch(*set, 1, {values.get()});
        ASSERT_EQ(contents(*values), std::vector<std::uint32_t>{round + 1});
    }
}

}  // namespace
}  // namespace spherule::compute

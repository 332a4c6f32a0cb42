#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstring>

#include "compute/cpu/device.h"
#include "compute/cpu/memory.h"

namespace spherule::compute::cpu {
namespace {

using HostWords = std::vector<std::uint32_t>;

std::uint32_t real(float value) {
    return std::bit_cast<std::uint32_t>(value);
}

std::unique_ptr<Buffer> bufferOf(std::size_t bytes, std::string_view words, Precision precision) {
    return CpuBuffer::create("test", bytes, Words(words, precision)).value();
}

HostWords roundTrip(const HostWords& values, std::string_view words, Precision precision) {
    const auto buffer = bufferOf(values.size() * 4, words, precision);
    const auto& memory = static_cast<const CpuBuffer&>(*buffer);
    memory.words().store(memory.data(), 0, std::as_bytes(std::span(values)));
    HostWords back(values.size());
    memory.words().load(memory.data(), 0, std::as_writable_bytes(std::span(back)));
    return back;
}

TEST(CpuMemory, FreesItsMemory) {
    const HostWords values{real(1.5F), 7, real(-0.1F), 0xffffffff, real(1e-30F), 3};
    for (const auto precision : {Precision::Single, Precision::Double})
        for (const auto* const words : {"ru", "u", "rururu"}) EXPECT_EQ(roundTrip(values, words, precision), values);
}

TEST(CpuMemory, StoresFloatsAsDoublesOnRequest) {
    const auto buffer = bufferOf(12, "ruu", Precision::Double);
    const auto& memory = static_cast<const CpuBuffer&>(*buffer);
    EXPECT_EQ(buffer->bytes(), 12U) << "to the host it is what it asked for";
    const HostWords values{real(0.25F), 5, 6};
    memory.words().store(memory.data(), 0, std::as_bytes(std::span(values)));
    double first = 0;
    std::array<std::uint32_t, 2> rest{};
    std::memcpy(&first, memory.data(), sizeof first);
    std::memcpy(rest.data(), memory.data() + sizeof first, sizeof rest);
    EXPECT_EQ(first, 0.25);
    EXPECT_EQ(rest, (std::array<std::uint32_t, 2>{5, 6}));
}

TEST(CpuMemory, RefusesMoreThanTheMachineHas) {
    const auto refused = CpuBuffer::create("pairs", std::size_t{1} << 44U, Words("u", Precision::Single));
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().kind, ErrorKind::Refused);
    EXPECT_NE(refused.error().text().find("use fewer spheres"), std::string::npos) << refused.error().text();
}

TEST(CpuMemory, ReachesAnyWord) {
    const auto buffer = bufferOf(48, "rru", Precision::Double);
    const auto& memory = static_cast<const CpuBuffer&>(*buffer);
    for (std::uint32_t k = 0; k < 12; ++k) {
        const std::uint32_t value = k % 3 == 2 ? k : real(static_cast<float>(k));
        memory.words().store(memory.data(), 4 * k, std::as_bytes(std::span(&value, 1)));
    }
    for (std::uint32_t k = 0; k < 12; ++k) {
        std::uint32_t value = 0;
        memory.words().load(memory.data(), 4 * k, std::as_writable_bytes(std::span(&value, 1)));
        EXPECT_EQ(value, k % 3 == 2 ? k : real(static_cast<float>(k))) << "word " << k;
    }
}

TEST(CpuMemory, IsCopiedWordByWord) {
    for (const auto* const choice : {"cpu:1", "cpu-double:1"}) {
        const auto device = openDevice(choice, "").value();
        const auto from = device->createBuffer("from", 24, "rru").value();
        const auto to = device->createBuffer("to", 36, "rru").value();
        const HostWords values{real(1), real(2), 3, real(4), real(5), 6};
        device->upload(*from, 0, std::as_bytes(std::span(values)));
        device->copy(*from, 4, 20, *to, 16);
        HostWords back(9);
        device->download(*to, 0, std::as_writable_bytes(std::span(back)));
        EXPECT_EQ(back, (HostWords{0, 0, 0, 0, real(2), 3, real(4), real(5), 6})) << choice;
    }
}

}  // namespace
}  // namespace spherule::compute::cpu

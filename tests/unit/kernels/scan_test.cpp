#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "kernels_support.h"

namespace spherule::kernels {
namespace {

std::vector<uint> expected(const std::vector<uint>& values) {
    std::vector<uint> sums(values.size());
    std::exclusive_scan(values.begin(), values.end(), sums.begin(), 0U);
    return sums;
}

TEST(KernelsAsCpp, KernelListIsNotEmpty) {
    // The number itself does not matter, but with an empty list the test would check nothing.
    EXPECT_GE(kernelNames().size(), 15U);
    EXPECT_THROW(launch("no_such_kernel", std::span<const Slot>(), {}), std::out_of_range);
}

TEST(KernelsAsCpp, PrefixSumsAgreeWithTheStandardLibrary) {
    std::mt19937 random(1);
    for (const std::size_t count : {1U, 255U, 256U, 257U, 65536U, 100000U}) {
        std::vector<uint> values(count);
        for (uint& value : values) value = random() % 7U;
        const std::vector<uint> wanted = expected(values);
        prefixSum(values);
        EXPECT_EQ(values, wanted) << count << " values";
    }
}

}  // namespace
}  // namespace spherule::kernels

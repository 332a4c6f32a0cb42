#include <gtest/gtest.h>

#include <numeric>
#include <thread>
#include <vector>

#include "compute/cpu/pool.h"

namespace spherule::compute::cpu {
namespace {

void countVisits(const void* context, std::uint32_t begin, std::uint32_t end) {
    auto& visits = **static_cast<std::vector<std::uint32_t>* const*>(context);
    for (std::uint32_t k = begin; k < end; ++k) ++visits[k];
}

std::vector<std::uint32_t> visitsOf(Pool& pool, std::uint32_t count, std::uint32_t grain) {
    std::vector<std::uint32_t> visits(count);
    auto* const pointer = &visits;
    pool.run(count, grain, countVisits, &pointer);
    return visits;
}

TEST(Pool, VisitsEachNumberOnceForAnyThreadsCountAndGrain) {
    for (const unsigned threads : {1U, 2U, 3U, 8U}) {
        Pool pool(threads);
        EXPECT_EQ(pool.threads(), threads);
        for (const std::uint32_t count : {0U, 1U, 2U, 15U, 16U, 17U, 1000U, 100'003U})
            for (const std::uint32_t grain : {1U, 16U, 1000U})
                ASSERT_EQ(visitsOf(pool, count, grain), std::vector<std::uint32_t>(count, 1))
                    << threads << " threads, " << count << " in ranges of " << grain;
    }
}

// Each run reads what other threads wrote in the run before.
TEST(Pool, RunSeesWritesOfPreviousRun) {
    Pool pool(4);
    std::vector<std::uint32_t> values(1000);
    std::vector<std::uint32_t> next(1000);
    struct Step {
        const std::vector<std::uint32_t>& from;
        std::vector<std::uint32_t>& to;
    };
    for (int round = 0; round < 20'000; ++round) {
        const Step step{values, next};
        pool.run(
            1000, 16,
            [](const void* context, std::uint32_t begin, std::uint32_t end) {
                const auto& [from, to] = *static_cast<const Step*>(context);
                for (std::uint32_t k = begin; k < end; ++k) to[k] = from[(k + 517) % 1000] + 1;
            },
            &step);
        values.swap(next);
    }
    EXPECT_EQ(values, std::vector<std::uint32_t>(1000, 20'000));
}

TEST(Pool, ThreadsThatSleptWakeUp) {
    Pool pool(3);
    for (int round = 0; round < 5; ++round) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        EXPECT_EQ(visitsOf(pool, 5000, 16), std::vector<std::uint32_t>(5000, 1));
    }
}

TEST(Pool, EndsWithoutRun) {
    for (int round = 0; round < 50; ++round) Pool(4);
}

}  // namespace
}  // namespace spherule::compute::cpu

#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <barrier>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

TEST(ForEachInParallel, CallsEveryNumberOnce) {
    std::vector<std::atomic<int>> calls(1000);
    for_each_in_parallel(calls.size(), [&](std::size_t i) { ++calls[i]; });
    for (const auto& count : calls) EXPECT_EQ(count, 1);
    for_each_in_parallel(0, [](std::size_t) { FAIL() << "there is nothing to do"; });
}

TEST(ForEachInParallel, TakesNoMoreThreadsThanItMay) {
    const auto caller = std::this_thread::get_id();
    for_each_in_parallel(
        100, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), caller); }, 1);
}

TEST(ForEachInParallel, ThrowsWhatTheLowestNumberThrew) {
    for (int trial = 0; trial < 200; ++trial) {
        try {
            for_each_in_parallel(50, [](std::size_t i) {
                if (i == 7 || i % 10 == 8) throw std::runtime_error(std::to_string(i));
            });
            FAIL() << "nothing was thrown";
        } catch (const std::runtime_error& error) {
            EXPECT_STREQ(error.what(), "7");
        }
    }
}

TEST(ForEachInParallel, HasOneThreadWithinALoopThatSeveralShare) {
    std::atomic<int> elsewhere = 0;
    const auto inner = [&](std::size_t max_threads) {
        for_each_in_parallel(
            2,
            [&](std::size_t) {
                const auto here = std::this_thread::get_id();
                for_each_in_parallel(
                    20, [&](std::size_t) { elsewhere += std::this_thread::get_id() != here; }, 4);
            },
            max_threads);
    };
    inner(2);
    EXPECT_EQ(elsewhere, 0);
    // A loop that needs one of its two threads leaves the other to the loop within it: of two calls each waits for the
    // other. Two are asked for, as a machine may have one core.
    std::barrier meeting(2);
    for_each_in_parallel(
        1,
        [&](std::size_t) {
            for_each_in_parallel(
                2, [&](std::size_t) { meeting.arrive_and_wait(); }, 2);
        },
        2);
}

}  // namespace
}  // namespace flightwatt

#include "live/source.h"

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

TEST(Source, ALineIsATimeAndAMessage) {
    const auto message = message_of_line("335.149 20 ENERGY 69 11.7 3.1 36.6 0.03 0.31");
    ASSERT_TRUE(message);
    EXPECT_EQ(message->time_s, 335.149);
    EXPECT_EQ(message->text, "20 ENERGY 69 11.7 3.1 36.6 0.03 0.31");
    EXPECT_EQ(line_of(*message, 7.0), "335.149 20 ENERGY 69 11.7 3.1 36.6 0.03 0.31");
    EXPECT_EQ(line_of({{}, "20 PONG "}, 7.25), "7.25 20 PONG ");
}

TEST(Source, WhatHasNoTimeIsNoMessage) {
    for (const auto* line : {"", " ", "335.149", "335.149 ", "nan 20 PONG", "inf 20 PONG", "12abc 20 PONG", "<html>"})
        EXPECT_FALSE(message_of_line(line)) << line;
}

}  // namespace
}  // namespace flightwatt::live

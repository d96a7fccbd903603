#include "live/sources/message_readers.h"

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using std::chrono::milliseconds;

TEST(MessageQueue, GivesTimesOfArrivalToMessagesWithoutOne) {
    MessageQueue queue(60.0);
    queue.push({std::nullopt, "1 A 1"});
    queue.push({5000.0, "1 A 2"});
    queue.push({std::nullopt, "1 A 3"});
    std::vector<IncomingMessage> messages;
    SourceReport report;
    queue.take(milliseconds(0), messages, report);
    ASSERT_EQ(messages.size(), 3U);
    EXPECT_GE(messages[0].time_s, 0.0);
    EXPECT_EQ(messages[1].time_s, 5000.0);
    EXPECT_GE(messages[2].time_s, messages[0].time_s);
    EXPECT_EQ(report.messages, 3U);
}

TEST(MessageQueue, DropsTheOldestOfTooManyAndSaysSo) {
    MessageQueue queue(1.0);
    for (std::size_t i = 0; i < MessageQueue::max_waiting + 3; ++i) queue.push({static_cast<double>(i), "1 A"});
    queue.count("bytes", 7);
    queue.count("bytes", 0);
    std::vector<IncomingMessage> messages;
    SourceReport report;
    while (messages.size() < MessageQueue::max_waiting) {
        const auto before = messages.size();
        queue.take(milliseconds(0), messages, report);
        ASSERT_GT(messages.size(), before);
        ASSERT_LE(messages.size() - before, MessageQueue::max_per_call);
    }
    queue.take(milliseconds(0), messages, report);
    EXPECT_EQ(messages.size(), MessageQueue::max_waiting);
    EXPECT_EQ(messages.front().time_s, 3.0);
    EXPECT_EQ(report.messages, MessageQueue::max_waiting + 3);
    EXPECT_EQ(report.unusable.at("messages dropped as they arrived faster than they were processed"), 3U);
    EXPECT_EQ(report.unusable.at("bytes"), 7U);
}

TEST(LineBuffer, LinesAreTheSameInAnyPieces) {
    const std::string text = "1.5 20 PONG \r\n\n2.5 20 ALIVE 1,2\nthe rest";
    const std::vector<std::string> expected{"1.5 20 PONG ", "", "2.5 20 ALIVE 1,2"};
    for (std::size_t size = 1; size <= text.size(); ++size) {
        LineBuffer buffer;
        std::vector<std::string> lines;
        for (std::size_t i = 0; i < text.size(); i += size) buffer.push(text.substr(i, size), lines);
        EXPECT_EQ(lines, expected) << size;
        EXPECT_EQ(buffer.take_partial_line(), "the rest");
        EXPECT_EQ(buffer.take_partial_line(), "");
    }
}

TEST(LineBuffer, AnEndlessLineIsDroppedAndTheNextIsRead) {
    LineBuffer buffer;
    std::vector<std::string> lines;
    std::size_t overlong = 0;
    for (int i = 0; i < 1000; ++i) overlong += buffer.push(std::string(1000, '#'), lines);
    overlong += buffer.push("\n1 20 PONG\n" + std::string(LineBuffer::max_line + 1, 'x') + "\n2 20 PONG\n", lines);
    EXPECT_EQ(lines, (std::vector<std::string>{"1 20 PONG", "2 20 PONG"}));
    EXPECT_EQ(overlong, 2U);
}

}  // namespace
}  // namespace flightwatt::live

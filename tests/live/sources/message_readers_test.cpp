#include "live/sources/message_readers.h"

#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

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

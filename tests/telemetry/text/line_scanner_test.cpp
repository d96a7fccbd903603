#include "telemetry/text/line_scanner.h"

#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using testing::ElementsAre;

std::vector<std::vector<std::string>> scan(const std::string& text) {
    // A copy of exact size, so that AddressSanitizer sees a read beyond the end.
    const std::vector<char> exact(text.begin(), text.end());
    std::vector<std::vector<std::string>> lines;
    const auto count = scan_lines({exact.data(), exact.size()}, [&](const ScannedLine& line) {
        std::vector<std::string> words;
        WordCursor cursor(line);
        const WordCursor at_begin = cursor;
        std::string_view word;
        while (cursor.next(word)) {
            words.emplace_back(word);
            EXPECT_EQ(at_begin.words_left(), words.size() + cursor.words_left());
        }
        EXPECT_EQ(at_begin.words_left(), words.size());
        const auto third = third_word(line);
        EXPECT_EQ(third.data() != nullptr, words.size() >= 3);
        EXPECT_EQ(third, words.size() >= 3 ? words[2] : "");
        EXPECT_EQ(line.number, lines.size() + 1);
        lines.push_back(words);
    });
    EXPECT_EQ(count, lines.size());
    return lines;
}

/// What is compiled for this machine (SSE2, NEON, or the same loop) against one byte after the other.
TEST(LineScanner, FindsBlanksAndBreaksAsALoopOverBytesDoes) {
    std::mt19937 random(5);
    const std::string alphabet = " \n\t\r!*\x1f\x8a\xa0\xff" + std::string(1, '\0');
    std::vector<char> bytes(block_size + 16);
    for (int round = 0; round < 20'000; ++round) {
        const bool any = round % 2 == 0;
        for (auto& byte : bytes) byte = any ? static_cast<char>(random()) : alphabet[random() % alphabet.size()];
        const char* const at = bytes.data() + random() % 16;  // of any alignment
        const auto expected = masks_of_bytes(at);
        const auto masks = masks_of(at);
        ASSERT_EQ(masks.blanks, expected.blanks) << "round " << round;
        ASSERT_EQ(masks.breaks, expected.breaks) << "round " << round;
    }
    for (unsigned i = 0; i < block_size; ++i) {  // each place alone
        std::string block(block_size, 'x');
        block[i] = ' ';
        EXPECT_EQ(masks_of(block.data()).blanks, std::uint64_t{1} << i);
        EXPECT_EQ(masks_of(block.data()).breaks, 0u);
        block[i] = '\n';
        EXPECT_EQ(masks_of(block.data()).breaks, std::uint64_t{1} << i);
        EXPECT_EQ(masks_of(block.data()).blanks, 0u);
    }
}

TEST(LineScanner, SplitsLinesAndWords) {
    EXPECT_THAT(scan("1.5 20 PONG \n2 20 GPS 1 2\n"),
                ElementsAre(ElementsAre("1.5", "20", "PONG"), ElementsAre("2", "20", "GPS", "1", "2")));
}

TEST(LineScanner, ToleratesAMissingLastBreakAndEmptyLines) {
    EXPECT_THAT(scan("a b\n\nc"), ElementsAre(ElementsAre("a", "b"), ElementsAre(), ElementsAre("c")));
    EXPECT_TRUE(scan("").empty());
}

TEST(LineScanner, AgreesWithASimpleSplitOnLinesOfAnyLength) {
    std::mt19937 random(3);
    for (int round = 0; round < 200; ++round) {
        std::string text;
        std::vector<std::vector<std::string>> expected;
        const int lines = 1 + static_cast<int>(random() % 20);
        for (int i = 0; i < lines; ++i) {
            std::vector<std::string> words;
            const int count = 1 + static_cast<int>(random() % 30);
            for (int w = 0; w < count; ++w) words.emplace_back(1 + random() % 90, 'x');
            for (std::size_t w = 0; w < words.size(); ++w) text += (w > 0 ? " " : "") + words[w];
            expected.push_back(words);
            if (i + 1 < lines || random() % 2 == 0) text += '\n';
        }
        ASSERT_EQ(scan(text), expected) << "round " << round;
    }
}

}  // namespace
}  // namespace flightwatt::telemetry

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

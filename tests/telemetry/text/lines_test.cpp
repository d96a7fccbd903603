#include "telemetry/text/lines.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using testing::ElementsAre;

std::vector<std::vector<std::string>> split(const std::string& text) {
    // A copy of exact size, so that AddressSanitizer sees a read beyond the end.
    const std::vector<char> exact(text.begin(), text.end());
    std::vector<std::vector<std::string>> lines;
    for_each_line({exact.data(), exact.size()}, [&](std::string_view rest) {
        lines.emplace_back();
        while (!rest.empty()) lines.back().emplace_back(take_word(rest));
    });
    return lines;
}

TEST(Lines, AreSplitIntoWords) {
    EXPECT_THAT(split("1.5 20 PONG \n2 20 GPS 1 2\n"),
                ElementsAre(ElementsAre("1.5", "20", "PONG"), ElementsAre("2", "20", "GPS", "1", "2")));
    EXPECT_THAT(split("a  b\n"), ElementsAre(ElementsAre("a", "", "b")));
}

TEST(Lines, MayBeEmptyOrLackTheLastBreak) {
    EXPECT_THAT(split("a b\n\nc"), ElementsAre(ElementsAre("a", "b"), ElementsAre(), ElementsAre("c")));
    EXPECT_TRUE(split("").empty());
}

}  // namespace
}  // namespace flightwatt::telemetry

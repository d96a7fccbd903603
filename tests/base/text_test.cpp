#include "base/text.h"

#include <random>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt {
namespace {

TEST(Utf8, ReplacesWhatIsNoCharacter) {
    EXPECT_EQ(valid_utf8(""), "");
    EXPECT_EQ(valid_utf8("Thévenin Ω 😀"), "Thévenin Ω 😀");
    EXPECT_EQ(valid_utf8("caf\xE9s"), "caf\uFFFDs");
    EXPECT_EQ(valid_utf8("\xE2\x82"), "\uFFFD") << "the beginning of a character";
    EXPECT_EQ(valid_utf8("\xC0\x80"), "\uFFFD\uFFFD") << "an overlong form";
    EXPECT_EQ(first_character("Ω").code, U'Ω');
    EXPECT_EQ(character_count("Thévenin Ω"), 10U);
}

TEST(Utf8, ReplacesAsJsonDoes) {
    using Json = nlohmann::json;
    std::mt19937 random(3);
    const std::string bytes = "a\x80\x9F\xA0\xBF\xC1\xC3\xE0\xE2\xED\xF0\xF1\xF4\xF5\xFF";
    for (int i = 0; i < 50'000; ++i) {
        std::string text(1 + random() % 6, ' ');
        for (auto& c : text) c = bytes[random() % bytes.size()];
        const auto dumped = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
        ASSERT_EQ(valid_utf8(text), Json::parse(dumped).get<std::string>());
    }
}

TEST(Text, IsTakenApart) {
    std::string_view rest = "a  b ";
    EXPECT_EQ(take_word(rest), "a");
    EXPECT_EQ(take_word(rest), "");
    EXPECT_EQ(take_word(rest), "b");
    EXPECT_TRUE(rest.empty());
    EXPECT_EQ(split("a, b,,c", ", "), (std::vector<std::string>{"a", "b", "c"}));
    EXPECT_TRUE(split("", ",").empty());
}

TEST(Text, HasLinesFromOne) {
    EXPECT_EQ(line_of_offset("a\nb", 1), 1U);
    EXPECT_EQ(line_of_offset("a\nb", 2), 2U);
    EXPECT_EQ(line_of_offset("a\nb", std::string_view::npos), 2U);
}

TEST(Text, MayBeginWithAByteOrderMark) {
    EXPECT_EQ(without_byte_order_mark("\xEF\xBB\xBF"
                                      "a"),
              "a");
    EXPECT_EQ(without_byte_order_mark("a"), "a");
    EXPECT_EQ(without_byte_order_mark(""), "");
}

}  // namespace
}  // namespace flightwatt

#include "telemetry/message_dictionary.h"

#include "helpers/binary_definitions.h"
#include "helpers/rejected.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using test::binary_dictionary;

TEST(MessageDictionary, FindsMessagesByClassAndId) {
    const auto dictionary = binary_dictionary();
    ASSERT_NE(dictionary.find(1, 42), nullptr);
    EXPECT_EQ(dictionary.find(1, 42)->definition.name, "ESTIMATOR") << "attributes may be upper case";
    EXPECT_EQ(dictionary.find(1, 42)->definition.fields.at(0).unit, "m");
    EXPECT_EQ(dictionary.find(1, 2)->definition.name, "ARRAYS") << "0x2";
    EXPECT_EQ(dictionary.find(2, 4)->definition.name, "SETTING");
    EXPECT_EQ(dictionary.find(3, 1)->definition.name, "NEW_AIRCRAFT") << "a class without a number has pprzlink's";
    EXPECT_EQ(dictionary.find(2, 42), nullptr);
    EXPECT_EQ(dictionary.find(1, 44), nullptr) << "300 is no byte";
    EXPECT_EQ(dictionary.find(1, 60), nullptr) << "of a field's type nothing is known";
    EXPECT_EQ(dictionary.find(255, 255), nullptr);
}

TEST(MessageDictionary, MeasuresPayloadsExactly) {
    const auto dictionary = binary_dictionary();
    const auto fits = [&](std::uint8_t id, const std::string& payload) {
        return dictionary.find(1, id)->fits(payload);
    };
    EXPECT_TRUE(fits(42, std::string(8, 'x')));
    EXPECT_FALSE(fits(42, std::string(7, 'x')));
    EXPECT_FALSE(fits(42, std::string(9, 'x')));
    EXPECT_TRUE(fits(3, ""));
    EXPECT_FALSE(fits(3, "x"));
    // uint8[2], float[3], char[1], char[5], int16[1]
    const std::string arrays =
        std::string("\2ab", 3) + std::string(12, '\0') + "\1c" + "defgh" + std::string("\1\0\0", 3);
    EXPECT_TRUE(fits(2, arrays));
    for (std::size_t size = 0; size < arrays.size(); ++size) EXPECT_FALSE(fits(2, arrays.substr(0, size))) << size;
    EXPECT_FALSE(fits(2, arrays + "x"));
    auto beyond = arrays;
    beyond[0] = '\xFF';
    EXPECT_FALSE(fits(2, beyond)) << "counts more than there is";
}

TEST(MessageDictionary, RefusesWhatDefinesNothing) {
    const auto folder = test::scratch_dir();
    test::write_text(folder / "x.xml", "<protocol></protocol>");
    test::write_text(folder / "y.xml", "hello");
    EXPECT_EQ(test::rejected([&] { read_message_dictionary(folder / "x.xml"); }, folder),
              "x.xml:1: its <protocol> defines no message");
    EXPECT_THAT(test::rejected([&] { read_message_dictionary(folder / "y.xml"); }, folder),
                testing::HasSubstr("y.xml: has no <protocol>"));
}

TEST(MessageDictionary, ReadsRealDefinitions) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto recent = read_message_dictionary(test::shared_dir() / "pprzlink" / "messages.xml");
    EXPECT_EQ(recent.find(1, 12)->definition.name, "ENERGY");
    EXPECT_EQ(recent.find(2, 4)->definition.name, "SETTING");
    const auto old = read_message_dictionary(test::shared_dir() / "flights" / "09_05_13__14_38_13.log");
    EXPECT_EQ(old.find(1, 12)->definition.name, "BAT");
}

}  // namespace
}  // namespace flightwatt::telemetry

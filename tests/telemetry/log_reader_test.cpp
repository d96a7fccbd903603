#include "telemetry/log_reader.h"

#include "helpers/rejected.h"
#include "helpers/test_paths.h"
#include "telemetry/data_file.h"

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<MessageRequest> energy{{"ENERGY", {"voltage", "power"}}, {"PONG", {}}};

std::vector<std::string> reasons(const TelemetryLog& log) {
    std::vector<std::string> texts;
    for (const auto& skip : log.skipped) {
        texts.push_back(skip.reason + " x" + std::to_string(skip.count()) + " from " +
                        std::to_string(skip.first_line()));
    }
    return texts;
}

TelemetryLog parse(std::string_view text, std::optional<LogConfiguration> configuration = std::nullopt) {
    return parse_telemetry(text, "x.data", std::move(configuration), energy);
}

TEST(TelemetryLog, BindsByTheBuiltInLayoutOfThatManyFields) {
    const auto six = parse("1.5 20 ENERGY 69 11.5 3. 34.5 0.1 0.2\n");
    EXPECT_THAT(six.senders[0].table("ENERGY")->column("power")->values, ElementsAre(34.5));
    ASSERT_EQ(six.assumed_definitions.size(), 1u);
    EXPECT_EQ(six.assumed_definitions[0].text, "ENERGY: 2018 (6 fields)");
    EXPECT_EQ(six.assumed_definitions[0].since_s, 1.5);
    const auto seven = parse("1.5 20 ENERGY 69 11.5 3. 34.5 30. 0.1 0.2\n");
    EXPECT_THAT(seven.senders[0].table("ENERGY")->column("power")->values, ElementsAre(34.5));
    const auto four = parse("1.5 20 ENERGY 11.4 2. 7 22.8\n");
    EXPECT_THAT(four.senders[0].table("ENERGY")->column("power")->values, ElementsAre(22.8))
        << "the integer energy in mAh stands before the power";
}

/// 60,000 senders took 38 s.
TEST(TelemetryLog, RefusesMoreSendersThanANetworkHas) {
    std::string text;
    for (int i = 1; i <= 300; ++i) text += "1.5 " + std::to_string(i) + " ENERGY 69 11.5 3. 34.5 0.1 0.2\n";
    EXPECT_EQ(parse(text).senders.size(), 300U);
    EXPECT_EQ(parse(text + text).senders.size(), 300U);
    EXPECT_EQ(test::rejected([&] { parse(text + "2 x ENERGY 69 11.5 3. 34.5 0.1 0.2\n"); }),
              "x.data:301: 'x' is the sender number 301 of this log; a network has fewer: the second word of a line "
              "should be an aircraft's id");
}

TEST(Census, StopsAtAThousandNames) {
    std::string text = "1 7 GPS 1\n";
    for (int i = 0; i < 5000; ++i) text += "1 7 N" + std::to_string(i) + " 1\n";
    text += "2 7 GPS 1\n";
    const auto census = count_messages(text);
    EXPECT_EQ(census.size(), 1000U);
    EXPECT_EQ(census.front(), (std::pair<std::string, std::size_t>("GPS", 2)));
}

TEST(TelemetryLog, BindsByTheFlightsOwnDefinition) {
    LogConfiguration configuration;
    configuration.messages["ENERGY"] = {
        "ENERGY", {{"power", "uint16", "mW", "", {}}, {"voltage", "uint8", "decivolt", "", {}}}, ".log"};
    const auto log = parse("1.5 20 ENERGY 34500 115\n2.5 20 ENERGY 1 2 3\n3 20 PONG \n", configuration);
    const auto* table = log.senders[0].table("ENERGY");
    EXPECT_THAT(table->column("power")->values, ElementsAre(34.5));
    EXPECT_THAT(table->column("voltage")->values, ElementsAre(11.5));
    EXPECT_THAT(reasons(log), ElementsAre("ENERGY: another number of fields than the .log defines x1 from 2",
                                          "PONG: not defined in the .log x1 from 3"));
}

TEST(TelemetryLog, CountsWhatItCannotUseByReasonAndFirstLine) {
    const auto log = parse(
        "1.5 20 ENERGY 69 11.5 3. 34.5 0.1 0.2\n"
        "garbage\n"
        "x 20 ENERGY 69 11.5 3. 34.5 0.1 0.2\n"
        "2.5 20 ENERGY 69 11.5 3. nan 0.1 0.2\n"
        "3.5 20 ENERGY 69 11.5 3.\n"
        "4.5 20 ENERGY 69 11.5 3. 34.x 0.1 0.2\n"
        "5.5 20 LOGGER_STATUS 1 0 0 , FLIGHT_RECORDER\\fr_0219.LOG\n"
        "6.5 20 ENERGY 69 11.5");
    EXPECT_THAT(reasons(log),
                ElementsAre("not a message (TIME SENDER NAME ...) x1 from 2",
                            "ENERGY: the time is not a number x1 from 3", "ENERGY.power: not a finite number x2 from 4",
                            "ENERGY: another number of fields than is known x2 from 5"));
    const auto& power = log.senders[0].table("ENERGY")->column("power")->values;
    ASSERT_EQ(power.size(), 3u);
    EXPECT_TRUE(std::isnan(power[1])) << "the row stays, for its other fields";
    EXPECT_EQ(log.senders[0].table("ENERGY")->column("voltage")->values[1], 11.5);
}

TEST(TelemetryLog, SaysThatTheLastLineIsCutOff) {
    const auto log = parse("1.5 20 ENERGY 69 11.5 3. 34.5 0.1 0.2\n2.5 20 ENERGY 69 11");
    EXPECT_THAT(reasons(log), ElementsAre("the last line is cut off x1 from 2"));
    const auto whole = parse("1.5 20 ENERGY 69 11.5 3. 34.5 0.1 0.2\n2.5 20 ENERGY 69 11.5 3. 34.5 0.1 0.2");
    EXPECT_TRUE(whole.skipped.empty()) << "a missing last break alone is no fault";
    EXPECT_EQ(whole.senders[0].table("ENERGY")->time_s.size(), 2u);
}

TEST(TelemetryLog, KeepsSendersApartAndReadsWindowsLineEnds) {
    const auto log = parse("1 20 ENERGY 69 11.5 3. 34.5 0.1 0.2\r\n1 7 ENERGY 0 12. 0. 0. 0. 0.\r\n2 20 PONG \r\n");
    ASSERT_EQ(log.senders.size(), 2u);
    EXPECT_EQ(log.senders[1].id, "7");
    EXPECT_THAT(log.senders[1].table("ENERGY")->column("power")->values, ElementsAre(0.0));
    EXPECT_TRUE(log.senders[0].table("ENERGY")->column("voltage")->values == std::vector<double>{11.5});
}

TEST(TelemetryLog, KeepsSendersInTheOrderOfTheirFirstLine) {
    std::string text = "1 7 ENERGY 0 12. 0. 0. 0. 0.\n";
    for (int i = 2; i < 100; ++i) text += std::to_string(i) + " 20 GPS 1\n";
    text += "100 20 PONG \n101 3 ENERGY 69 11.5 3. 34.5 0.1 0.2\n";
    const auto log = parse_telemetry(
        text, "x.data",
        LogConfiguration{{}, {}, {{"ENERGY", builtin_definitions("ENERGY")[1]}, {"PONG", {"PONG", {}, ".log"}}}, {}},
        energy);
    ASSERT_EQ(log.senders.size(), 3u);
    EXPECT_EQ(log.senders[0].id, "7");
    EXPECT_EQ(log.senders[1].id, "20");
    EXPECT_EQ(log.senders[2].id, "3");
}

TEST(TelemetryLog, SurvivesEveryCutAndEveryChangedByte) {
    const std::string text = "1.5 20 ENERGY 69 11.5 3. 34.5 0.1 0.2\n2 20 ENERGY 69 11.5 3. 34.5 0.1 0.2\n3 20 PONG \n";
    for (std::size_t cut = 0; cut <= text.size(); ++cut) {
        const std::vector<char> exact(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(cut));
        EXPECT_NO_THROW(parse({exact.data(), exact.size()})) << cut;
    }
    for (std::size_t i = 0; i < text.size(); ++i) {
        for (const char c : {'\0', '\n', ' ', '\xFF', '9'}) {
            auto changed = text;
            changed[i] = c;
            EXPECT_NO_THROW(parse(changed)) << i;
        }
    }
}

TEST(TelemetryLog, RefusesTextsWithoutTelemetry) {
    const std::string rubbish("\x7F\x45LF\0\1 \2 \3\n\0\0\0 x y", 18);
    EXPECT_THAT(test::rejected([&] { read_telemetry(rubbish, "rubbish.data", std::nullopt, energy); }),
                HasSubstr("has no telemetry"));
    EXPECT_THAT(test::rejected([&] { read_telemetry(rubbish, "rubbish.bin", std::nullopt, energy); }),
                HasSubstr("rubbish.bin: is no log that is known; expected a .bin or .log of ArduPilot"));
}

TEST(TelemetryLog, ReadsTheRealLogs) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto file = test::shared_dir() / "flights" / "20_07_05__10_26_44.data";
    const auto data = read_data_file(file);
    const auto configuration = read_log_configuration(find_log_file(file).value());
    const auto log = read_telemetry(data, file, configuration, energy);
    ASSERT_EQ(log.senders.size(), 1u);
    EXPECT_EQ(log.senders[0].id, "20");
    EXPECT_EQ(log.senders[0].table("ENERGY")->time_s.size(), 945u);
    EXPECT_TRUE(log.skipped.empty());
    EXPECT_TRUE(log.assumed_definitions.empty());
}

TEST(TelemetryLog, ReadsTheFirstElementOfAnArray) {
    const std::vector<MessageRequest> first{{"COMMANDS", {"values[0]"}}};
    const auto log = parse_telemetry("1 20 COMMANDS 7889,-2927,-945\n2 20 COMMANDS 12\n3 20 COMMANDS ,1\n", "x.data",
                                     std::nullopt, first);
    const auto& values = log.senders[0].table("COMMANDS")->column("values")->values;
    ASSERT_EQ(values.size(), 3U);
    EXPECT_EQ(values[0], 7889.0);
    EXPECT_EQ(values[1], 12.0);
    EXPECT_TRUE(std::isnan(values[2]));
    const std::vector<MessageRequest> whole{{"COMMANDS", {"values"}}};
    const auto other = parse_telemetry("1 20 COMMANDS 7889,-2927,-945\n", "x.data", std::nullopt, whole);
    EXPECT_TRUE(std::isnan(other.senders[0].table("COMMANDS")->column("values")->values[0])) << "is no number";
}

}  // namespace
}  // namespace flightwatt::telemetry

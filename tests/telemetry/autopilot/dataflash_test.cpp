#include "helpers/autopilot_logs.h"
#include "helpers/rejected.h"
#include "telemetry/autopilot_log.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using units::Quantity;

AutopilotLog read_bytes(const std::string& bytes, const std::vector<MessageRequest>& wanted) {
    return read_autopilot_logs(bytes, detect_autopilot_format(bytes).value(), "x.bin", wanted).front();
}

std::string fmtu(std::uint8_t type, std::string_view units, std::string_view multipliers) {
    return test::dataflash_message(20, test::little_endian(std::uint64_t{0}) + test::little_endian(type) +
                                           test::padded(units, 16) + test::padded(multipliers, 16));
}

std::string unit(char id, std::string_view label) {
    return test::dataflash_message(21, test::little_endian(std::uint64_t{0}) + id + test::padded(label, 64));
}

std::string mult(char id, double factor) {
    return test::dataflash_message(22, test::little_endian(std::uint64_t{0}) + id + test::little_endian(factor));
}

const std::string unit_formats = test::dataflash_format(20, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds", 41) +
                                 test::dataflash_format(21, "UNIT", "QbZ", "TimeUS,Id,Label", 73) +
                                 test::dataflash_format(22, "MULT", "Qbd", "TimeUS,Id,Mult", 17);

TEST(Dataflash, FieldsHaveTheFactorsOfTheirLetters) {
    const auto log =
        test::dataflash_format(1, "ALL", "QbHcELfgdM", "TimeUS,b,H,c,E,L,f,g,d,M",
                               8 + 1 + 2 + 2 + 4 + 4 + 4 + 2 + 8 + 1) +
        test::dataflash_message(
            1, test::little_endian(std::uint64_t{2'500'000}) + '\xFF' + test::little_endian(std::uint16_t{65535}) +
                   test::little_endian(std::int16_t{-250}) + test::little_endian(std::uint32_t{1234}) +
                   test::little_endian(std::int32_t{-434'567'890}) + test::little_endian(11.62F) +
                   test::little_endian(std::uint16_t{0x3E00}) + test::little_endian(0.1) + '\x05');
    const auto read = read_bytes(log, {{"ALL", {"b", "H", "c", "E", "L", "f", "g", "d", "M", "absent"}}});
    const auto& table = test::table_of(read, "ALL");
    ASSERT_EQ(table.columns.size(), 9U);
    EXPECT_THAT(table.time_s, ElementsAre(2.5));
    std::vector<double> values;
    for (const auto& column : table.columns) values.push_back(column.values.at(0));
    EXPECT_THAT(values, ElementsAre(-1.0, 65535.0, -2.5, DoubleNear(12.34, 1e-12), DoubleNear(-43.456789, 1e-12), 11.62,
                                    testing::IsNan(), 0.1, 5.0));
    EXPECT_TRUE(table.columns[0].is_integer);
    EXPECT_FALSE(table.columns[5].is_integer);
}

TEST(Dataflash, UnitsAreThoseOfTheLog) {
    const auto log = unit_formats + test::dataflash_format(1, "BAT", "QhcfH", "TimeUS,Volt,Temp,Used,X", 18) +
                     fmtu(1, "svOX?", "FBB0B") + unit('v', "V") + unit('O', "degC") + unit('X', "W.h") +
                     unit('?', "UNKNOWN") + mult('B', 0.009999999776482582) + mult('0', 1.0) +
                     test::dataflash_message(1, test::little_endian(std::uint64_t{1'000'000}) +
                                                    test::little_endian(std::int16_t{1234}) +
                                                    test::little_endian(std::int16_t{2500}) +
                                                    test::little_endian(3.5F) + test::little_endian(std::uint16_t{7}));
    const auto read = read_bytes(log, {{"BAT", {"Volt", "Temp", "Used", "X"}}});
    const auto& columns = test::table_of(read, "BAT").columns;
    ASSERT_EQ(columns.size(), 4U);
    EXPECT_EQ(columns[0].quantity, Quantity::volt);
    EXPECT_DOUBLE_EQ(columns[0].values[0], 12.34);
    EXPECT_EQ(columns[1].quantity, Quantity::celsius);
    EXPECT_DOUBLE_EQ(columns[1].values[0], 25.0) << "its letter has the factor already";
    EXPECT_EQ(columns[2].quantity, Quantity::watt_hour);
    EXPECT_EQ(columns[3].quantity, std::nullopt);
    EXPECT_EQ(columns[3].values[0], 7.0);
}

TEST(Dataflash, OldMessagesHaveATimeBetweenTheirNeighbours) {
    const auto log =
        test::dataflash_format(1, "CURR", "Ih", "TimeMS,Volt", 6) + test::dataflash_format(2, "MODE", "M", "Mode", 1) +
        test::dataflash_format(3, "GPS", "BII", "Status,TimeMS,T", 9) + test::dataflash_message(2, "\x01") +
        test::dataflash_message(1, test::little_endian(std::uint32_t{4900}) + test::little_endian(std::int16_t{1480})) +
        test::dataflash_message(1, test::little_endian(std::uint32_t{5000}) + test::little_endian(std::int16_t{1480})) +
        test::dataflash_message(2, "\x02") +
        test::dataflash_message(
            3, '\x03' + test::little_endian(std::uint32_t{400'000'000}) + test::little_endian(std::uint32_t{5100}));
    const auto read = read_bytes(log, {{"CURR", {"Volt"}}, {"MODE", {"Mode"}}, {"GPS", {"Status"}}});
    EXPECT_THAT(test::table_of(read, "CURR").time_s, ElementsAre(4.9, 5.0));
    EXPECT_THAT(test::table_of(read, "MODE").time_s, ElementsAre(DoubleNear(5.05, 1e-9)));
    EXPECT_THAT(test::table_of(read, "GPS").time_s, ElementsAre(5.1)) << "TimeMS is that of the week";
    EXPECT_TRUE(read.log.skipped.empty());
}

TEST(Dataflash, TextHasTheSameColumns) {
    const auto log = std::string(
        "Log of APM\r\nFMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\r\n"
        "FMT, 1, 13, CURR, Ihf, TimeMS,Volt,Curr\r\nFMT, 3, 67, MSG, Z, Message\r\n"
        "MSG, ArduCopter V3.1.3, of 2014\r\nCURR, 5000, 1480, 12.5\r\nCURR, 5100, 1481\r\n"
        "CURR, 5200, 1482, 12.7\r\n");
    const auto read = read_bytes(log, {{"CURR", {"Volt", "Curr"}}});
    const auto& table = test::table_of(read, "CURR");
    EXPECT_THAT(table.time_s, ElementsAre(5.0, 5.2));
    EXPECT_THAT(table.columns[0].values, ElementsAre(1480.0, 1482.0));
    EXPECT_TRUE(table.columns[0].is_integer);
    EXPECT_THAT(table.columns[1].values, ElementsAre(12.5, 12.7));
    EXPECT_THAT(read.facts.texts, ElementsAre("Log of APM", "ArduCopter V3.1.3, of 2014"));
    ASSERT_EQ(read.log.skipped.size(), 1U);
    EXPECT_EQ(describe(read.log.skipped[0]), "no message: 1 line, first at line 7");
}

TEST(Dataflash, OldestLogsHaveTheTimeOfTheGpsWeek) {
    const auto read = read_bytes(
        "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\nFMT, 1, 5, CURR, h, Volt\n"
        "FMT, 2, 8, GPS, BI, Status,Time\nGPS, 0, 0\nCURR, 1470\nGPS, 3, 400000000\nCURR, 1480\nGPS, 3, 400000200\n"
        "CURR, 1481\n",
        {{"CURR", {"Volt"}}, {"GPS", {"Status"}}});
    EXPECT_THAT(test::table_of(read, "CURR").time_s,
                ElementsAre(DoubleNear(400000.1, 1e-6), DoubleNear(400000.3, 1e-6)));
    EXPECT_THAT(test::table_of(read, "GPS").time_s, ElementsAre(400000.0, 400000.2));
}

/// A text log in which only GPS has times [ms], with a CURR before each GPS and one after it.
std::string log_of_gps_times(const std::vector<unsigned>& times_ms) {
    std::string log =
        "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\nFMT, 1, 5, CURR, h, Volt\n"
        "FMT, 2, 8, GPS, BI, Status,Time\n";
    for (const auto time_ms : times_ms) log += fmt::format("CURR, 1\nGPS, 3, {}\nCURR, 2\n", time_ms);
    return log;
}

TEST(Dataflash, APauseOfALogTimedByGpsIsNoDamage) {
    const auto read = read_bytes(log_of_gps_times({1000, 1200, 1400, 1600, 43600, 43800, 44000}),
                                 {{"CURR", {"Volt"}}, {"GPS", {"Status"}}});
    EXPECT_TRUE(read.log.skipped.empty());
    const auto& curr = test::table_of(read, "CURR");
    EXPECT_THAT(test::table_of(read, "GPS").time_s, ElementsAre(1.0, 1.2, 1.4, 1.6, 43.6, 43.8, 44.0));
    ASSERT_EQ(curr.time_s.size(), 13U) << "one of 14 is before the first time";
    for (std::size_t i = 0; i < curr.time_s.size(); ++i) {
        const double time_s = curr.time_s[i];
        EXPECT_TRUE(time_s < 1.8 || time_s > 43.6) << time_s << " is in the pause";
        EXPECT_TRUE(i == 0 || time_s > curr.time_s[i - 1]);
    }
}

TEST(Dataflash, ALogTimedByGpsContinuesOnSunday) {
    const auto read = read_bytes(log_of_gps_times({604'799'600, 604'799'800, 200, 400}), {{"GPS", {"Status"}}});
    EXPECT_THAT(test::table_of(read, "GPS").time_s, ElementsAre(604799.6, 604799.8, 604800.2, 604800.4));
}

TEST(Dataflash, RowsLongBeforeOrAfterTheLastTimeAreCounted) {
    auto log = log_of_gps_times({1000, 1200});
    for (int i = 0; i < 1000; ++i) log += "CURR, 3\n";
    const auto read = read_bytes(log, {{"CURR", {"Volt"}}, {"GPS", {"Status"}}});
    EXPECT_LT(test::table_of(read, "CURR").time_s.back(), 11.3);
    ASSERT_EQ(read.log.skipped.size(), 1U);
    EXPECT_THAT(describe(read.log.skipped[0]), testing::StartsWith("messages without a time: "));
    auto late = log_of_gps_times({});
    for (int i = 0; i < 20; ++i) late += "CURR, 3\n";
    const auto lines = log_of_gps_times({});
    const auto begun = read_bytes(late + log_of_gps_times({1000, 1200}).substr(lines.size()), {{"CURR", {"Volt"}}});
    ASSERT_EQ(begun.log.skipped.size(), 1U);
    EXPECT_EQ(describe(begun.log.skipped[0]), "messages without a time: 21 lines, first at line 4");
}

TEST(Dataflash, ALogWithoutAnyTimeIsRefused) {
    EXPECT_THAT(
        test::rejected([&] {
            read_bytes(log_of_gps_times({}) + "CURR, 1\nCURR, 2\n", {{"CURR", {"Volt"}}});
        }),
        HasSubstr("no message has a time, also none of 2 that are used; in logs of ArduPilot before 3.1 only GPS"));
}

TEST(Dataflash, AMessageMayBeDefinedAgain) {
    const auto row = [](unsigned time_s, const std::string& values) {
        return test::dataflash_message(1, test::little_endian(std::uint64_t{time_s} * 1'000'000) + values);
    };
    const auto log =
        unit_formats + test::dataflash_format(1, "BAT", "Qhf", "TimeUS,Volt,CurrTot", 14) + fmtu(1, "svX", "FB0") +
        unit('v', "V") + unit('X', "mAh") + mult('B', 0.01) + mult('0', 1.0) +
        row(1, test::little_endian(std::int16_t{1234}) + test::little_endian(100.0F)) +
        row(2, test::little_endian(std::int16_t{1235}) + test::little_endian(200.0F)) +
        test::dataflash_format(1, "BAT", "Qffh", "TimeUS,CurrTot,Curr,Volt", 18) +
        row(3, test::little_endian(300.0F) + test::little_endian(7.0F) + test::little_endian(std::int16_t{1236})) +
        fmtu(1, "sXAv", "F00B") + unit('A', "A");
    const auto read = read_bytes(log, {{"BAT", {"Volt", "Curr", "CurrTot"}}});
    const auto& columns = test::table_of(read, "BAT").columns;
    ASSERT_EQ(columns.size(), 3U);
    EXPECT_THAT(columns[0].values, ElementsAre(12.34, 12.35, 12.36));
    EXPECT_THAT(columns[1].values, ElementsAre(testing::IsNan(), testing::IsNan(), 7.0));
    EXPECT_THAT(columns[2].values, ElementsAre(0.1, 0.2, DoubleNear(0.3, 1e-12)));
    EXPECT_EQ(columns[1].quantity, Quantity::ampere);
}

TEST(Dataflash, AMessageDefinedAgainKeepsItsUnits) {
    const auto log = unit_formats + test::dataflash_format(1, "BAT", "Qf", "TimeUS,CurrTot", 12) + fmtu(1, "sX", "F0") +
                     unit('X', "mAh") + mult('0', 1.0) +
                     test::dataflash_format(1, "BAT", "Qff", "TimeUS,V,CurrTot", 16) +
                     test::dataflash_message(1, test::little_endian(std::uint64_t{1'000'000}) +
                                                    test::little_endian(12.0F) + test::little_endian(300.0F));
    const auto read = read_bytes(log, {{"BAT", {"CurrTot"}}});
    EXPECT_THAT(test::table_of(read, "BAT").columns.at(0).values, ElementsAre(DoubleNear(0.3, 1e-12)));
}

TEST(Dataflash, Sdlog2HasItsTimesInAMessageBeforeTheOthers) {
    auto log =
        test::dataflash_format(129, "TIME", "Q", "StartTime", 8) + test::dataflash_format(20, "BATT", "ff", "V,C", 8);
    for (std::uint64_t i = 0; i < 4; ++i)
        log += test::dataflash_message(129, test::little_endian(std::uint64_t{3'000'000} + 100'000 * i)) +
               test::dataflash_message(20, test::little_endian(16.0F) + test::little_endian(static_cast<float>(i)));
    EXPECT_EQ(detect_autopilot_format(log), AutopilotFormat::sdlog2);
    EXPECT_EQ(to_string(AutopilotFormat::sdlog2), "PX4 sdlog2 log");
    const auto read = read_bytes(log, {{"BATT", {"C"}}});
    const auto& table = test::table_of(read, "BATT");
    ASSERT_EQ(table.time_s.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(table.time_s[i], 3.05 + 0.1 * static_cast<double>(i), 1e-6);
    EXPECT_TRUE(read.log.skipped.empty());
}

TEST(Dataflash, AMessageCountsIfAnotherFollows) {
    const std::vector<MessageRequest> wanted{{"BAT", {"Volt"}}};
    auto log = test::dataflash_log(10);
    EXPECT_EQ(test::table_of(read_bytes(log + std::string(200, '\xFF'), wanted), "BAT").time_s.size(), 10U) << "a page";
    log.resize(log.size() - 3);
    EXPECT_EQ(test::table_of(read_bytes(log, wanted), "BAT").time_s.size(), 10U);
    log.resize(log.size() - 15);
    const auto read = read_bytes(log, wanted);
    EXPECT_EQ(test::table_of(read, "BAT").time_s.size(), 9U);
    EXPECT_EQ(read.log.skipped.at(0).count(), 16U);
    EXPECT_EQ(read.log.skipped.at(0).unit, SkippedLines::Unit::byte);
}

TEST(Dataflash, FactsAreTextsAndParameters) {
    const auto log = test::dataflash_log(1) + test::dataflash_format(9, "PARM", "QNf", "TimeUS,Name,Value", 28) +
                     test::dataflash_message(9, test::little_endian(std::uint64_t{0}) +
                                                    test::padded("BATT_CAPACITY", 16) + test::little_endian(5000.0F));
    const auto read = read_bytes(log, {});
    EXPECT_EQ(read.facts.parameters.at("BATT_CAPACITY"), 5000.0);
    EXPECT_EQ(read.facts.texts.size(), 2U);
}

}  // namespace
}  // namespace flightwatt::telemetry

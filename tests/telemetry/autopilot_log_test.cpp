#include "telemetry/autopilot_log.h"

#include "base/input_file.h"
#include "helpers/autopilot_logs.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <iterator>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using testing::HasSubstr;

const std::vector<MessageRequest> all_batteries{
    {"BAT", {"Volt", "Curr"}}, {"BARO", {"Alt"}}, {"battery_status", {"voltage_v", "current_a", "multi_id"}}};

AutopilotLog read_any(const std::string& bytes) {
    const auto format = detect_autopilot_format(bytes);
    if (!format) return {};
    return read_autopilot_logs(bytes, *format, "x.log", all_batteries).front();
}

/// The rows of all tables, as text without their places.
std::vector<std::vector<double>> rows_of(const AutopilotLog& read) {
    std::vector<std::vector<double>> rows;
    for (const auto& sender : read.log.senders) {
        for (const auto& table : sender.tables) {
            for (std::size_t i = 0; i < table.time_s.size(); ++i) {
                rows.push_back({static_cast<double>(table.message.size()), table.time_s[i]});
                for (const auto& column : table.columns) rows.back().push_back(column.values[i]);
            }
        }
    }
    std::ranges::sort(rows);
    return rows;
}

TEST(AutopilotLog, IsRecognisedByItsContent) {
    EXPECT_EQ(detect_autopilot_format(test::dataflash_log(3)), AutopilotFormat::dataflash);
    EXPECT_EQ(detect_autopilot_format(test::dataflash_log(3).substr(100)), AutopilotFormat::dataflash);
    EXPECT_EQ(detect_autopilot_format(test::ulog_log(3)), AutopilotFormat::ulog);
    EXPECT_EQ(detect_autopilot_format("ArduCopter V3.1\n\nFMT, 128, 89, FMT, BBnNZ, Type,Length\n"),
              AutopilotFormat::dataflash_text);
    EXPECT_EQ(detect_autopilot_format("12.3 7 ENERGY 57 11.6 1.6\n"), std::nullopt);
    EXPECT_EQ(detect_autopilot_format(""), std::nullopt);
}

TEST(AutopilotLog, MessagesAreCounted) {
    const auto messages = read_any(test::dataflash_log(5)).messages;
    ASSERT_EQ(messages.size(), 4U);
    EXPECT_EQ(messages[0].name, "BAT");
    EXPECT_EQ(messages[0].count, 5U);
    EXPECT_THAT(messages[0].fields, testing::ElementsAre("TimeUS", "Volt", "Curr"));
    const auto topics = read_any(test::ulog_log(5)).messages;
    ASSERT_EQ(topics.size(), 1U);
    EXPECT_EQ(topics[0].count, 10U);
    EXPECT_THAT(topics[0].fields, testing::ElementsAre("multi_id", "timestamp", "voltage_v", "current_a", "connected"));
}

/// A copy without a part has no row that the whole has not, but the one that is joined of two halves; DataFlash has no
/// checksum. One with zeros has fewer.
TEST(AutopilotLog, DamageInventsNothing) {
    std::mt19937 random(7);
    for (const auto& whole : {test::dataflash_log(200), test::ulog_log(200)}) {
        const auto definitions = (whole.starts_with("ULog") ? test::ulog_log(0) : test::dataflash_log(0)).size();
        const auto expected = rows_of(read_any(whole));
        ASSERT_EQ(expected.size(), 400U);
        for (int copy = 0; copy < 300; ++copy) {
            const auto at = definitions + random() % (whole.size() - definitions);
            const auto size = std::min(1 + random() % 500, whole.size() - at);
            auto cut = whole;
            cut.erase(at, size);
            const auto kept = rows_of(read_any(cut));
            std::vector<std::vector<double>> invented;
            std::ranges::set_difference(kept, expected, std::back_inserter(invented));
            EXPECT_LE(invented.size(), 1U) << copy;
            EXPECT_GE(kept.size() + 60, expected.size()) << copy;
            auto zeroed = whole;
            zeroed.replace(at, size, size, '\0');
            EXPECT_LE(rows_of(read_any(zeroed)).size(), expected.size()) << copy;
        }
    }
}

TEST(AutopilotLog, AnyBytesAreRead) {
    std::mt19937 random(11);
    for (const auto& whole : {test::dataflash_log(50), test::ulog_log(50)}) {
        for (int copy = 0; copy < 2000; ++copy) {
            auto flipped = whole;
            const auto flips = 1 + random() % 40;
            for (unsigned i = 0; i < flips; ++i)
                flipped[random() % whole.size()] ^= static_cast<char>(1U << random() % 8);
            flipped.resize(whole.size() - random() % 300);
            const auto attempt = [&] { EXPECT_LE(rows_of(read_any(flipped)).size(), 110U); };
            EXPECT_THAT(test::rejected(attempt),
                        testing::AnyOf("", HasSubstr("newer ULog"), HasSubstr("no message has a time")));
        }
    }
}

TEST(AutopilotLog, TimesThatLeaveTheClockAreDropped) {
    auto log = test::dataflash_log(20);
    const auto late = test::dataflash_message(
        1, test::little_endian(std::uint64_t{1} << 50) + test::little_endian(16.0F) + test::little_endian(9.0F));
    const auto read = read_any(log + late + test::dataflash_log(40).substr(log.size()));
    EXPECT_EQ(test::table_of(read, "BAT").time_s.size(), 40U);
    ASSERT_EQ(read.log.skipped.size(), 1U);
    EXPECT_THAT(describe(read.log.skipped[0]), HasSubstr("whose time is damaged"));
}

TEST(AutopilotLog, TooMuchDamageIsRefused) {
    auto zeros = test::dataflash_log(2);
    zeros.append(65'000'000, '\0');
    EXPECT_THAT(test::rejected([&] { read_any(zeros); }), HasSubstr("more than 64 MB that are no messages"));
}

}  // namespace
}  // namespace flightwatt::telemetry

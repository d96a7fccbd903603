#include "helpers/autopilot_logs.h"
#include "helpers/rejected.h"
#include "telemetry/autopilot_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<MessageRequest> batteries{{"battery_status", {"voltage_v", "multi_id"}}};

AutopilotLog read_log(const std::string& bytes, const std::vector<MessageRequest>& wanted = batteries) {
    return read_autopilot_logs(bytes, AutopilotFormat::ulog, "x.ulg", wanted).front();
}

TEST(Ulog, TopicsHaveInstances) {
    const auto read = read_log(test::ulog_log(2));
    const auto& table = test::table_of(read, "battery_status");
    EXPECT_THAT(table.time_s, ElementsAre(10.0, 10.000004, 10.2, 10.200004));
    EXPECT_THAT(table.columns[1].values, ElementsAre(0.0, 1.0, 0.0, 1.0));
    EXPECT_TRUE(read.log.skipped.empty()) << "padding at the end is not written";
    EXPECT_EQ(read.facts.information.at("sys_uuid"), "0A1B");
    EXPECT_EQ(read.facts.parameters.at("MAV_TYPE"), 2.0);
}

TEST(Ulog, FieldsAreFoundByNameAlsoBehindOtherFormats) {
    const auto log =
        test::ulog_header() + test::ulog_message('F', "point:float x;float[2] y;") +
        test::ulog_message('F', "topic:uint64_t timestamp;point[2] points;float[3] control;int16_t last;") +
        test::ulog_subscription(0, 1, "topic") +
        test::ulog_message('D', test::little_endian(std::uint16_t{1}) + test::little_endian(std::uint64_t{3'000'000}) +
                                    std::string(24, '\x01') + test::little_endian(1.0F) + test::little_endian(2.0F) +
                                    test::little_endian(3.0F) + test::little_endian(std::int16_t{-4}));
    const auto read = read_log(log, {{"topic", {"control[2]", "last", "control[3]", "points"}}});
    const auto& table = test::table_of(read, "topic");
    ASSERT_EQ(table.columns.size(), 2U);
    EXPECT_THAT(table.columns[0].values, ElementsAre(3.0));
    EXPECT_THAT(table.columns[1].values, ElementsAre(-4.0));
}

TEST(Ulog, AnArrayOfOneHasAnIndex) {
    const auto log =
        test::ulog_header() + test::ulog_message('F', "topic:uint64_t timestamp;float[1] control;") +
        test::ulog_subscription(0, 1, "topic") +
        test::ulog_message('D', test::little_endian(std::uint16_t{1}) + test::little_endian(std::uint64_t{3'000'000}) +
                                    test::little_endian(0.5F));
    const auto read = read_log(log, {{"topic", {"control[0]"}}});
    ASSERT_EQ(test::table_of(read, "topic").columns.size(), 1U);
    EXPECT_THAT(test::table_of(read, "topic").columns[0].values, ElementsAre(0.5));
}

TEST(Ulog, DataOfAnotherSizeAreDropped) {
    auto log = test::ulog_log(3);
    log += test::ulog_message(
        'D', test::little_endian(std::uint16_t{7}) + test::little_endian(std::uint64_t{11'000'000}) + "xyz");
    log += test::ulog_battery(7, 11.0, 22.0F, 1.0F);
    const auto read = read_log(log);
    EXPECT_EQ(test::table_of(read, "battery_status").time_s.size(), 7U);
    EXPECT_EQ(read.log.skipped.at(0).count(), 16U);
}

TEST(Ulog, DropoutsAndTextsAreFacts) {
    const auto log = test::ulog_log(1) + test::ulog_message('O', test::little_endian(std::uint16_t{250})) +
                     test::ulog_message('L', std::string(9, '6') + "Takeoff detected");
    const auto read = read_log(log);
    EXPECT_EQ(read.facts.dropouts, 1U);
    EXPECT_DOUBLE_EQ(read.facts.dropout_s, 0.25);
    EXPECT_THAT(read.facts.texts, ElementsAre("Takeoff detected"));
}

TEST(Ulog, DataAppendedAfterACrashAreRead) {
    auto log = test::ulog_log(5);
    const auto second = log.size() - 10;  // the last message is cut
    log.resize(second);
    const auto offset = test::little_endian(static_cast<std::uint64_t>(second));
    log[16 + 3 + 8] = '\x01';
    log.replace(16 + 3 + 16, offset.size(), offset);
    log += test::ulog_battery(7, 11.0, 22.0F, 1.0F) + test::ulog_battery(8, 11.0, 22.0F, 1.0F);
    EXPECT_EQ(test::table_of(read_log(log), "battery_status").time_s.size(), 11U);
}

TEST(Ulog, HostileFormatsAreRejected) {
    auto nested = test::ulog_header();
    for (int i = 0; i < 30; ++i)
        nested += test::ulog_message('F', "f" + std::to_string(i) + ":f" + std::to_string(i + 1) + "[9999] x;");
    nested += test::ulog_message('F', "f30:f0 x;") + test::ulog_message('F', "t:uint64_t timestamp;f0 x;") +
              test::ulog_subscription(0, 1, "t") +
              test::ulog_message('D', test::little_endian(std::uint16_t{1}) + std::string(30, '\x01'));
    EXPECT_TRUE(test::table_of(read_log(nested, {{"t", {"x"}}}), "t").empty());
    EXPECT_THAT(test::rejected([] { read_log(test::ulog_header(2)); }),
                HasSubstr("has features of a newer ULog (incompatible flags 0x2 in byte 0)"));
}

}  // namespace
}  // namespace flightwatt::telemetry

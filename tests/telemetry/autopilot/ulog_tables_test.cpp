#include "telemetry/autopilot/ulog_tables.h"

#include "helpers/rejected.h"
#include "telemetry/autopilot_log.h"
#include "telemetry/log_configuration.h"
#include "telemetry/ulog_folder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<MessageRequest> wanted{{"battery_status", {"voltage_v", "q[1]", "multi_id"}},
                                         {"vehicle_status", {"arming_state"}}};

/// A folder with the tables of two logs.
std::filesystem::path tables() {
    auto folder = test::scratch_dir();
    test::write_text(folder / "log_2_battery_status_0.csv",
                     "timestamp,q[0],q[1],voltage_v\n0,0,0,0\n1000000,1,2,12.5\n1500000,1,3,nan\n");
    test::write_text(folder / "log_2_battery_status_1.csv", "timestamp;voltage_v\n1200000;24,5\n1700000;24,0\n");
    test::write_text(folder / "log_2_vehicle_status_0.csv", "timestamp,arming_state\n1100000,1\n1600000,2\n");
    test::write_text(folder / "log_2_cpuload_0.csv", "timestamp,load\n1,x\n");
    test::write_text(folder / "log_battery_status_0.csv", "timestamp,voltage_v\n1,1\n");
    return folder;
}

TEST(UlogTables, AreFoundByAnyOfThem) {
    const auto folder = tables();
    for (const auto* name : {"battery_status_1", "vehicle_status_0", "cpuload_0", "battery_status_0"})
        EXPECT_EQ(find_ulog_tables(folder / fmt::format("log_2_{}.csv", name)), folder / "log_2_battery_status_0.csv");
    EXPECT_EQ(find_ulog_tables(folder / "log_battery_status_0.csv"), folder / "log_battery_status_0.csv");
    EXPECT_EQ(flight_name(folder / "log_2_battery_status_0.csv"), "log_2");
    EXPECT_EQ(flight_name("a_battery_status_x.csv"), "a_battery_status_x");
    EXPECT_EQ(find_ulog_tables(test::write_text(folder / "other_0.csv", "timestamp,x\n")), std::nullopt);
    EXPECT_EQ(find_ulog_tables(test::write_text(folder / "log_2_own_0.csv", "time_s,power_w\n")), std::nullopt);
}

TEST(UlogTables, AreReadAsOneLog) {
    const auto folder = tables();
    const auto file = folder / "log_2_battery_status_0.csv";
    const auto text = join_ulog_tables(file, wanted, 100'000);
    ASSERT_EQ(detect_autopilot_format(text), AutopilotFormat::ulog_tables);
    const auto read = read_autopilot_logs(text, AutopilotFormat::ulog_tables, file, wanted).front();
    EXPECT_EQ(read.log.flight, "log_2");
    const auto& sender = read.log.senders.at(0);
    const auto* battery = sender.table("battery_status");
    ASSERT_NE(battery, nullptr);
    EXPECT_THAT(battery->time_s, ElementsAre(1.0, 1.2, 1.5, 1.7));
    EXPECT_THAT(battery->column("multi_id")->values, ElementsAre(0.0, 1.0, 0.0, 1.0));
    EXPECT_THAT(battery->column("voltage_v")->values, ElementsAre(12.5, 24.5, testing::IsNan(), 24.0));
    EXPECT_THAT(battery->column("q[1]")->values, ElementsAre(2.0, testing::IsNan(), 3.0, testing::IsNan()));
    EXPECT_THAT(sender.table("vehicle_status")->column("arming_state")->values, ElementsAre(1.0, 2.0));
    ASSERT_EQ(read.messages.size(), 2U);
    EXPECT_EQ(read.messages[0].name, "battery_status");
    EXPECT_EQ(read.messages[0].count, 5U);
}

TEST(UlogTables, NameTheTableThatIsWrong) {
    const auto folder = tables();
    test::write_text(folder / "log_2_vehicle_status_0.csv", "timestamp,arming_state\n1100000\n");
    const auto file = folder / "log_2_battery_status_0.csv";
    const auto read = [&] {
        read_autopilot_logs(join_ulog_tables(file, wanted, 100'000), AutopilotFormat::ulog_tables, file, wanted);
    };
    EXPECT_EQ(test::rejected(read, folder), "log_2_vehicle_status_0.csv:2: 1 cells, expected 2 as in the first line");
    test::write_text(folder / "log_2_vehicle_status_0.csv", "time,arming_state\n1,2\n");
    EXPECT_EQ(test::rejected(read, folder),
              "log_2_vehicle_status_0.csv:1: has no column 'timestamp'; is it by ulog2csv?");
    EXPECT_THAT(test::rejected([&] { join_ulog_tables(file, wanted, 100); }), HasSubstr("holds more than"));
}

}  // namespace
}  // namespace flightwatt::telemetry

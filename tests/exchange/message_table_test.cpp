#include "exchange/message_table.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "helpers/mavlink_packets.h"
#include "helpers/rejected.h"
#include "helpers/sample_logs.h"
#include "helpers/selected_tracks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::exchange {
namespace {

std::string rejection_of(const std::filesystem::path& log, const std::string& message,
                         const std::optional<std::string>& sender = std::nullopt) {
    try {
        message_table(flight::FlightFile(log), message, sender);
    } catch (const InputError& error) {
        return std::string(error.what()) + "; " + error.hint();
    }
    return "accepted";
}

TEST(MessageTable, HasTimeFirstAndEveryFieldInItsBaseUnit) {
    const auto table = message_table(flight::FlightFile(test::sample(1)), "GPS", std::nullopt);
    const auto csv = parse_csv(table.csv, "gps.csv");
    EXPECT_EQ(csv.columns.front(), "time_s");
    EXPECT_GT(csv.rows.size(), 100U);
    // utm_east is logged in cm, speed in cm/s.
    const auto east = column_index(csv, "utm_east_m");
    EXPECT_GT(cell_number(csv, csv.rows[0], east), 1e5);
    EXPECT_LT(cell_number(csv, csv.rows[0], east), 9e5);
    EXPECT_NO_THROW(column_index(csv, "speed_m_per_s"));
}

TEST(MessageTable, HasThePowerThatTheSeriesHas) {
    const auto csv = parse_csv(message_table(flight::FlightFile(test::sample(1)), "ENERGY", "7").csv, "energy.csv");
    const auto power = power_track(flight::read_flight(test::sample(1)));
    ASSERT_EQ(csv.rows.size(), power.time_s.size());
    const auto column = column_index(csv, "power_w");
    for (std::size_t i = 0; i < power.time_s.size(); ++i) {
        EXPECT_DOUBLE_EQ(cell_number(csv, csv.rows[i], 0), power.time_s[i]);
        EXPECT_DOUBLE_EQ(cell_number(csv, csv.rows[i], column), power.value[i]);
    }
}

TEST(MessageTable, HasNoDigitsThatOnlyTheConversionPutThere) {
    const auto log = test::scratch_dir() / "gps.data";
    write_file_atomically(log, "1.0 7 GPS 3 36000007 462000011 2712 4123 3 0 2112 469045600 31 0\n");
    const auto csv = parse_csv(message_table(flight::FlightFile(log), "GPS", std::nullopt).csv, "gps.csv");
    EXPECT_EQ(csv.rows[0].cells[column_index(csv, "itow_s")].text, "469045.6");
}

TEST(MessageTable, SaysWhatTheLogHoldsInstead) {
    EXPECT_THAT(rejection_of(test::sample(1), "NO_SUCH"),
                testing::HasSubstr("contains no readable NO_SUCH; it contains "));
    EXPECT_THAT(rejection_of(test::sample(1), "ENERGY", "99"), testing::HasSubstr("aircraft 99 sent no ENERGY"));
    const auto bare = test::scratch_dir() / "bare.data";
    write_file_atomically(bare, "1.0 7 ODD 3\n1.5 7 GPS 3 1 2 0 1 2 3 2112 4 31 0\n");
    EXPECT_THAT(rejection_of(bare, "ODD"), testing::HasSubstr("has no definition of ODD"));
}

TEST(MessageTable, AsksWhichOfSeveralSenders) {
    const auto log = test::scratch_dir() / "two.data";
    write_file_atomically(log, "1.0 7 ENERGY 50 11.7 3.1 36.6 0.03 0.31\n1.1 8 ENERGY 50 11.7 3.1 36.6 0.03 0.31\n");
    EXPECT_THAT(rejection_of(log, "ENERGY"), testing::HasSubstr("2 senders sent ENERGY: 7, 8; choose one"));
    EXPECT_EQ(message_table(flight::FlightFile(log), "ENERGY", "8").csv,
              "time_s,throttle_percent,voltage_v,current_a,power_w,charge_ah,energy_wh\n"
              "1.1,50,11.7,3.1,36.6,0.03,0.31\n");
}

/// --aircraft, which the error asks for, was not used.
TEST(MessageTable, OfSeveralVehiclesHasTheOneThatIsNamed) {
    using testing::AllOf;
    using testing::HasSubstr;
    using testing::Not;
    test::MavlinkSender first{1, 1};
    test::MavlinkSender second{42, 1};
    std::string log;
    for (int i = 0; i < 20; ++i)
        for (auto* vehicle : {&first, &second})
            log += test::tlog_entry(i, vehicle->heartbeat()) +
                   test::tlog_entry(i, vehicle->status(vehicle == &first ? 15'800 : 11'100, 100));
    const auto file = test::write_text(test::scratch_dir() / "two.tlog", log);
    const auto csv_of = [&](const char* name) {
        return message_table(flight::FlightFile(file), "SYS_STATUS", name).csv;
    };
    EXPECT_THAT(rejection_of(file, "SYS_STATUS"), HasSubstr("choose one with --aircraft"));
    EXPECT_THAT(csv_of("1"), AllOf(HasSubstr("15800"), Not(HasSubstr("11100"))));
    EXPECT_THAT(csv_of("ArduCopter 42"), AllOf(HasSubstr("11100"), Not(HasSubstr("15800"))));
    EXPECT_THAT(rejection_of(file, "SYS_STATUS", "3"), HasSubstr("it was sent by 1, 42"));
}

TEST(MessageTable, IsNotMadeOfASeries) {
    const auto series = test::scratch_dir() / "s.csv";
    write_file_atomically(series, "time_s,power_w\n0,1\n1,2\n");
    EXPECT_THAT(rejection_of(series, "ENERGY"), testing::HasSubstr("is a series"));
}

TEST(SeriesTable, IsTheSeriesFileWithoutComments) {
    const auto series = flight::read_flight(test::sample(1));
    const auto text = series_table(series);
    EXPECT_TRUE(text.starts_with("time_s,")) << text.substr(0, 80);
    EXPECT_EQ(text.find('#'), std::string::npos);
    const auto csv = parse_csv(text, "series.csv");
    EXPECT_GT(csv.rows.size(), power_track(series).time_s.size());
}

}  // namespace
}  // namespace flightwatt::exchange

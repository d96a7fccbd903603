#include "live/recorder.h"

#include "base/atomic_file.h"
#include "helpers/mavlink_packets.h"
#include "helpers/test_paths.h"
#include "telemetry/autopilot_log.h"
#include "telemetry/mavlink_decoder.h"

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

TEST(Recorder, WritesLogsThatCanBeReadAtOnce) {
    const auto folder = test::scratch_dir() / "new";
    Recorder recorder(folder, "a", "<log/>");
    EXPECT_TRUE(recorder.file().empty());
    recorder.write("1 20 PONG\n", false);
    EXPECT_EQ(read_file(folder / "a.data"), "1 20 PONG\n");
    EXPECT_EQ(read_file(folder / "a.log"), "<log/>");
    recorder.write("2 20 PONG\n", false);
    recorder.write("0 20 PONG\n", true);
    EXPECT_EQ(read_file(folder / "a.data"), "1 20 PONG\n2 20 PONG\n");
    EXPECT_EQ(read_file(folder / "a_2.data"), "0 20 PONG\n");
    EXPECT_EQ(recorder.file(), folder / "a_2.data");
}

/// A .tlog with times of 1970 cannot be read: the recording of a computer without a battery for its clock was lost.
TEST(Recorder, BeginsIn2001WhereTheClockIsNotSet) {
    EXPECT_EQ(recording_start_unix_s(1.78e9), 1.78e9);
    const double start_unix_s = recording_start_unix_s(60.0);
    test::MavlinkSender vehicle;
    const auto entry = telemetry::tlog_entry(start_unix_s, vehicle.heartbeat());
    EXPECT_EQ(log_name(static_cast<std::int64_t>(start_unix_s)), "01_01_01__00_00_00");
    using telemetry::AutopilotFormat;
    EXPECT_EQ(telemetry::read_autopilot_logs(entry + entry, AutopilotFormat::tlog, "a.tlog", {}).size(), 1U);
}

TEST(Recorder, NeverWritesToAFileThatExists) {
    const auto folder = test::scratch_dir();
    write_file_atomically(folder / "a.data", "mine");
    write_file_atomically(folder / "a_2.log", "mine");
    Recorder recorder(folder, "a", std::nullopt);
    recorder.write("1 20 PONG\n", false);
    EXPECT_EQ(read_file(folder / "a.data"), "mine");
    EXPECT_EQ(read_file(folder / "a_2.log"), "mine");
    EXPECT_EQ(read_file(folder / "a_3.data"), "1 20 PONG\n");
}

TEST(Recorder, GivesUpWhereItCannotWrite) {
    const auto folder = test::scratch_dir() / "absent";
    Recorder recorder(folder, "a", std::nullopt);
    std::filesystem::remove(folder);
    recorder.write("1 20 PONG\n", false);
    EXPECT_FALSE(recorder.failure().empty());
    recorder.write("2 20 PONG\n", false);
}

TEST(Recorder, NamesLogsAsPaparazziDoes) { EXPECT_EQ(log_name(1593778665), "20_07_03__12_17_45"); }

}  // namespace
}  // namespace flightwatt::live

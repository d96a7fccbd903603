#include "batch/batch_files.h"

#include "base/atomic_file.h"
#include "flight/phases_file.h"
#include "flight/series_file.h"
#include "helpers/rejected.h"
#include "helpers/sample_logs.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

void write_record(const std::filesystem::path& out, const std::string& flight, const std::filesystem::path& log) {
    FlightRecord record;
    record.flight = flight;
    record.log = log.string();
    make_directories(out / "flights");
    write_file_atomically(out / "flights" / (flight + record_ending), to_json_text(record));
}

std::vector<std::string> words(const std::vector<DroppedFlight>& dropped) {
    std::vector<std::string> lines;
    lines.reserve(dropped.size());
    for (const auto& flight : dropped) lines.push_back(flight.flight + ", " + flight.reason);
    return lines;
}

TEST(LeftOvers, SayWhyAFlightIsDropped) {
    const auto folder = test::scratch_dir();
    const auto out = folder / "out";
    EXPECT_THAT(find_dropped({{"here.data", "here"}}, out), IsEmpty());  // no folder yet
    const auto kept = folder / "kept.data";
    write_file_atomically(kept, "1 7 ENERGY\n");
    write_record(out, "here", "here.data");
    write_record(out, "gone", folder / "gone.data");
    write_record(out, "kept", kept);
    write_record(out, "moved_2", "moved.data");
    write_file_atomically(out / "flights" / (std::string("damaged") + record_ending), "{");
    const std::vector<LogFile> logs{{"here.data", "here"}, {"moved.data", "moved"}};
    EXPECT_THAT(words(find_dropped(logs, out)), ElementsAre("damaged, its log is gone", "gone, its log is gone",
                                                            "kept, its log " + kept.string() + " is not in this batch",
                                                            "moved_2, it is called moved now"));
    remove_left_overs(logs, out);
    EXPECT_THAT(find_dropped(logs, out), IsEmpty());
    EXPECT_TRUE(std::filesystem::exists(out / "flights" / "here.record.json"));
}

TEST(LeftOvers, AreRemovedFromTheOutputFolderToo) {
    const auto out = test::scratch_dir() / "out";
    make_directories(out / "flights");
    for (const auto* file :
         {"flights.csv.Ab3dEf", "model.toml.000000", "table1.md.ABCDEF", "flights/a.phases.csv.x1x1x1"}) {
        write_file_atomically(out / file, "half");
    }
    for (const auto* file :
         {"flights.csv", "flights.csv.backup", "model.toml", "notes.txt.Ab3dEf", "model.toml.Ab3-Ef"}) {
        write_file_atomically(out / file, "whole");
    }
    remove_left_overs({{"a.data", "a"}}, out);
    std::vector<std::string> left;
    for (const auto& [name, content] : test::contents(out)) left.push_back(name);
    EXPECT_THAT(
        left, ElementsAre("flights.csv", "flights.csv.backup", "model.toml", "model.toml.Ab3-Ef", "notes.txt.Ab3dEf"));
}

TEST(StoredFlights, AreWhatTheBatchLeft) {
    const auto scratch = test::scratch_dir();
    test::copy_sample(1, scratch / "in");
    test::copy_sample(2, scratch / "in", "<b> \"x\"");
    write_file_atomically(scratch / "in" / "rubbish.data", "rubbish\n");
    const auto done = test::batch(scratch / "in", scratch / "out");
    const auto stored = read_stored_flights(scratch / "out");
    ASSERT_EQ(stored.size(), 3U);
    EXPECT_EQ(stored[0].record.flight, "<b> \"x\"");
    EXPECT_EQ(stored[1].record.flight, "opterra_synthetic_01");
    EXPECT_FALSE(stored[2].record.accepted);
    EXPECT_THAT(stored[2].record.error, HasSubstr("rubbish.data"));
    EXPECT_EQ(stored[1].series.current_origin, flight::CurrentOrigin::sensor);
    ASSERT_EQ(stored[1].record.verdicts.size(), 4U);
    EXPECT_THAT(stored[1].record.verdicts[0].text, HasSubstr("agrees with TAKEOFF"));
    const auto files = test::contents(scratch / "out");
    EXPECT_EQ(to_csv(stored[1].series), files.at("flights/opterra_synthetic_01.series.csv"));
    EXPECT_EQ(phases_csv(stored[1].series, stored[1].phases), files.at("flights/opterra_synthetic_01.phases.csv"));
}

TEST(StoredFlights, RefuseWhatIsNoBatchFolder) {
    const auto scratch = test::scratch_dir();
    EXPECT_THAT(test::rejected([&] { read_stored_flights(scratch); }), HasSubstr("no flights/ in it"));
    make_directories(scratch / "flights");
    EXPECT_THAT(test::rejected([&] { read_stored_flights(scratch); }), HasSubstr("no record of a flight"));
    test::write_text(scratch / "flights" / "a.record.json", "{}");
    EXPECT_THAT(test::rejected([&] { read_stored_flights(scratch); }), HasSubstr("run flightwatt batch again"));
}

}  // namespace
}  // namespace flightwatt::batch

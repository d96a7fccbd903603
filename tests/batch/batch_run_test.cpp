#include "batch/batch_run.h"

#include "base/error.h"
#include "helpers/rejected.h"
#include "helpers/sample_logs.h"

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

using test::batch;
using test::contents;
using test::copy_sample;
using test::done_anew;
using test::write_text;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

constexpr auto one = "opterra_synthetic_01";
constexpr auto two = "opterra_synthetic_02";

/// A batch over two samples, and what it wrote.
class BatchOfTwo : public testing::Test {
  protected:
    std::filesystem::path folder = test::scratch_dir();
    std::filesystem::path in = folder / "in";
    std::filesystem::path out = folder / "out";
    std::filesystem::path flights = out / "flights";
    std::map<std::string, std::string> whole;

    void SetUp() override {
        copy_sample(1, in);
        copy_sample(2, in);
        EXPECT_THAT(done_anew(batch(in, out)), ElementsAre(one, two));
        whole = contents(out);
    }

    /// Runs again and expects what the first run wrote, byte for byte.
    void expect_redone(const std::vector<std::string>& names) {
        EXPECT_EQ(done_anew(batch(in, out)), names);
        EXPECT_EQ(contents(out), whole);
        EXPECT_THAT(done_anew(batch(in, out)), IsEmpty());
        EXPECT_EQ(contents(out), whole);
    }
};

TEST_F(BatchOfTwo, WritesThreeFilesAFlight) {
    std::vector<std::string> names;
    for (const auto& [name, content] : whole) {
        names.push_back(name);
        EXPECT_FALSE(content.empty()) << name;
    }
    EXPECT_THAT(
        names, UnorderedElementsAre(
                   "flights.csv", "flights/opterra_synthetic_01.phases.csv", "flights/opterra_synthetic_01.record.json",
                   "flights/opterra_synthetic_01.series.csv", "flights/opterra_synthetic_02.phases.csv",
                   "flights/opterra_synthetic_02.record.json", "flights/opterra_synthetic_02.series.csv"));
}

TEST_F(BatchOfTwo, DoesNothingTwice) { expect_redone({}); }

TEST_F(BatchOfTwo, RemembersWhatAFitTakes) {
    const auto anew = batch(in, folder / "other");
    const auto remembered = batch(in, out);
    ASSERT_EQ(remembered.size(), 2U);
    for (std::size_t i = 0; i < remembered.size(); ++i) {
        ASSERT_EQ(remembered[i].selection.flights.size(), 1U);
        const auto& a = anew[i].selection.flights[0].samples;
        const auto& b = remembered[i].selection.flights[0].samples;
        EXPECT_EQ(a.flight, b.flight);
        for (const auto phase : flight::all_phases) {
            EXPECT_EQ(a.phases[phase]->duration_s, b.phases[phase]->duration_s);
            EXPECT_EQ(a.phases[phase]->tau, b.phases[phase]->tau);
            EXPECT_EQ(a.phases[phase]->power_w, b.phases[phase]->power_w);
        }
    }
}

TEST_F(BatchOfTwo, GoesOnWhereAKilledOneStopped) {
    std::filesystem::remove(flights / "opterra_synthetic_02.record.json");  // the last file that is written
    expect_redone({two});
    std::filesystem::remove(flights / "opterra_synthetic_01.record.json");
    std::filesystem::remove(flights / "opterra_synthetic_01.phases.csv");
    expect_redone({one});
    std::filesystem::remove_all(flights);
    expect_redone({one, two});
}

TEST_F(BatchOfTwo, DoesDamagedResultsAgain) {
    for (const auto* file :
         {"opterra_synthetic_01.series.csv", "opterra_synthetic_01.phases.csv", "opterra_synthetic_01.record.json"}) {
        std::filesystem::resize_file(flights / file, std::filesystem::file_size(flights / file) / 2);
        expect_redone({one});
        write_text(flights / file, "");
        expect_redone({one});
        std::filesystem::remove(flights / file);
        expect_redone({one});
    }
    // Still a series, of the same length, but not what was written.
    auto edited = read_file(flights / "opterra_synthetic_02.series.csv");
    edited[edited.size() - 2] = edited[edited.size() - 2] == '1' ? '2' : '1';
    write_text(flights / "opterra_synthetic_02.series.csv", edited);
    expect_redone({two});
}

TEST_F(BatchOfTwo, RemovesWhatAKilledOneLeft) {
    write_text(flights / "opterra_synthetic_01.series.csv.Ab3dEf", "time_s,po");
    write_text(flights / "gone.series.csv", "time_s,power_w\n");  // killed before its record was written
    write_text(flights / "gone.phases.csv.qwerty", "");
    expect_redone({});
}

TEST_F(BatchOfTwo, LeavesOtherFilesAlone) {
    write_text(flights / "notes.txt", "mine");
    write_text(flights / "series.csv.backup1", "mine");
    batch(in, out);
    EXPECT_EQ(read_file(flights / "notes.txt"), "mine");
    EXPECT_EQ(read_file(flights / "series.csv.backup1"), "mine");
}

TEST_F(BatchOfTwo, DoesAChangedLogAgain) {
    const auto before = batch(in, out)[0].record;
    copy_sample(3, in, one);
    const auto flights_now = batch(in, out);
    EXPECT_THAT(done_anew(flights_now), ElementsAre(one));
    EXPECT_NE(flights_now[0].record.phases[1].start_s, before.phases[1].start_s);
    copy_sample(1, in, one);
    expect_redone({one});
}

TEST_F(BatchOfTwo, DoesALogAgainWhoseDefinitionsChanged) {
    std::ofstream(in / "opterra_synthetic_02.log", std::ios::app) << "<!-- changed -->\n";
    EXPECT_THAT(done_anew(batch(in, out)), ElementsAre(two));
    std::filesystem::remove(in / "opterra_synthetic_02.log");
    EXPECT_THAT(done_anew(batch(in, out)), ElementsAre(two));
    copy_sample(2, in);
    expect_redone({two});
}

TEST_F(BatchOfTwo, DropsALogThatVanished) {
    std::filesystem::remove(in / "opterra_synthetic_01.data");
    const auto flights_now = batch(in, out);
    ASSERT_EQ(flights_now.size(), 1U);
    EXPECT_TRUE(flights_now[0].was_up_to_date);
    for (const auto& [name, content] : contents(out)) {
        EXPECT_EQ(name.find(one), std::string::npos) << name;
        EXPECT_EQ(content.find(one), std::string::npos) << name;
    }
    copy_sample(1, in);
    expect_redone({one});
}

TEST_F(BatchOfTwo, RecordsALogThatBecameBad) {
    write_text(in / "opterra_synthetic_01.data", "rubbish\n");
    const auto flights_now = batch(in, out);
    EXPECT_FALSE(flights_now[0].record.accepted);
    EXPECT_THAT(flights_now[0].record.error, HasSubstr("opterra_synthetic_01.data:1: holds no telemetry"));
    EXPECT_TRUE(flights_now[1].was_up_to_date);
    EXPECT_FALSE(std::filesystem::exists(flights / "opterra_synthetic_01.series.csv"));
    EXPECT_FALSE(std::filesystem::exists(flights / "opterra_synthetic_01.phases.csv"));
    const auto rejected = contents(out);
    EXPECT_THAT(done_anew(batch(in, out)), IsEmpty());  // known to be bad
    EXPECT_EQ(contents(out), rejected);
    write_text(flights / "opterra_synthetic_01.series.csv", "time_s,power_w\n");  // of a killed run
    EXPECT_THAT(done_anew(batch(in, out)), ElementsAre(one));
    EXPECT_EQ(contents(out), rejected);
    copy_sample(1, in);
    expect_redone({one});
}

TEST(Batch, DoesNotDependOnTheNumberOfJobs) {
    const auto folder = test::scratch_dir();
    for (int number = 1; number <= 6; ++number) copy_sample(number, folder / "in");
    write_text(folder / "in" / "bad.data", "rubbish\n");
    batch(folder / "in", folder / "one", 1);
    for (const unsigned jobs : {0U, 2U, 7U, 50U}) {
        const auto out = folder / std::to_string(jobs);
        const auto flights = batch(folder / "in", out, jobs);
        EXPECT_EQ(contents(out), contents(folder / "one")) << jobs;
        std::vector<std::string> names;
        names.reserve(flights.size());
        for (const auto& flight : flights) names.push_back(flight.record.flight);
        EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
    }
}

TEST(Batch, TellsItsProgressOfEveryLogOnce) {
    const auto folder = test::scratch_dir();
    for (int number = 1; number <= 4; ++number) copy_sample(number, folder / "in");
    std::vector<std::size_t> counts;
    std::vector<std::string> names;
    run_batch(find_logs({(folder / "in").string()}), {folder / "out", {}, 3, 8},
              [&](std::size_t done, std::size_t all, const BatchFlight& flight) {
                  EXPECT_EQ(all, 4U);
                  counts.push_back(done);
                  names.push_back(flight.record.flight);
              });
    EXPECT_THAT(counts, ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(names, UnorderedElementsAre(one, two, "opterra_synthetic_03", "opterra_synthetic_04"));
}

TEST(Batch, KeepsFlightsOfOneNameApart) {
    const auto folder = test::scratch_dir();
    copy_sample(1, folder / "in" / "monday", "flight");
    copy_sample(2, folder / "in" / "tuesday", "flight");
    const auto flights = batch(folder / "in", folder / "out");
    ASSERT_EQ(flights.size(), 2U);
    EXPECT_EQ(flights[0].selection.flights.at(0).samples.flight, "flight");
    EXPECT_EQ(flights[1].selection.flights.at(0).samples.flight, "flight_2");
    const auto written = folder / "out" / "flights";
    EXPECT_NE(read_file(written / "flight.series.csv"), read_file(written / "flight_2.series.csv"));
    EXPECT_THAT(done_anew(batch(folder / "in", folder / "out")), IsEmpty());
    // The name belongs to the place in the list: what moves up is done again, not mistaken for the other.
    const auto tuesday = read_file(written / "flight_2.series.csv");
    std::filesystem::remove_all(folder / "in" / "monday");
    EXPECT_THAT(done_anew(batch(folder / "in", folder / "out")), ElementsAre("flight"));
    EXPECT_EQ(std::regex_replace(tuesday, std::regex("\"flight_2\""), "\"flight\""),
              read_file(written / "flight.series.csv"));
    EXPECT_FALSE(std::filesystem::exists(written / "flight_2.series.csv"));
}

TEST(Batch, ReadsTheNamedAircraft) {
    const auto folder = test::scratch_dir();
    copy_sample(1, folder / "in");
    const auto logs = find_logs({(folder / "in").string()});
    const auto silent = [](std::size_t, std::size_t, const BatchFlight&) {};
    const auto right = run_batch(logs, {folder / "out", "7", 1, 8}, silent);
    EXPECT_TRUE(right[0].record.accepted);
    const auto wrong = run_batch(logs, {folder / "out", "9", 1, 8}, silent);
    EXPECT_FALSE(wrong[0].was_up_to_date);  // another aircraft, another result
    EXPECT_THAT(wrong[0].record.error, HasSubstr("aircraft 9 sent nothing"));
}

TEST(Batch, FailsWhereItCannotWrite) {
    const auto folder = test::scratch_dir();
    copy_sample(1, folder / "in");
    write_text(folder / "file", "in the way");
    EXPECT_THROW(batch(folder / "in", folder / "file"), OutputError);
    std::filesystem::create_directories(folder / "out" / "flights" / "opterra_synthetic_01.series.csv" / "x");
    EXPECT_THROW(batch(folder / "in", folder / "out"), OutputError);
    EXPECT_FALSE(std::filesystem::exists(folder / "out" / "flights" / "opterra_synthetic_01.record.json"));
}

TEST(Batch, ReportsNamesThatAreNotUtf8TheSameWayTwice) {
    const auto folder = test::scratch_dir();
    copy_sample(1, folder / "in", "good\xFF");
    write_text(folder / "in" / "bad\xFF.data", "rubbish\n");
    EXPECT_THAT(done_anew(batch(folder / "in", folder / "out")), ElementsAre("bad\xFF", "good\xFF"));
    const auto first = contents(folder / "out");
    EXPECT_THAT(done_anew(batch(folder / "in", folder / "out")), IsEmpty());
    EXPECT_EQ(contents(folder / "out"), first);
}

}  // namespace
}  // namespace flightwatt::batch

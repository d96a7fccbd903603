#include "batch/batch_run.h"

#include "base/error.h"
#include "batch/batch_files.h"
#include "helpers/rejected.h"
#include "helpers/sample_logs.h"

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

using test::batch;
using test::contents;
using test::copy_sample;
using test::done_anew;
using test::samples_of;
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

    /// The same next to files of the user's.
    void expect_redone_beside(const std::vector<std::string>& others, const std::vector<std::string>& names) {
        EXPECT_EQ(done_anew(batch(in, out)), names);
        auto left = contents(out);
        for (const auto& other : others) left.erase(other);
        EXPECT_EQ(left, whole);
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
    EXPECT_THAT(names, UnorderedElementsAre(
                           "batch.json", "flights.csv", "flights/opterra_synthetic_01.phases.csv",
                           "flights/opterra_synthetic_01.record.json", "flights/opterra_synthetic_01.series.csv",
                           "flights/opterra_synthetic_02.phases.csv", "flights/opterra_synthetic_02.record.json",
                           "flights/opterra_synthetic_02.series.csv"));
}

TEST_F(BatchOfTwo, DoesNothingTwice) { expect_redone({}); }

TEST_F(BatchOfTwo, RemembersWhatAFitTakes) {
    const auto again = samples_of(batch(in, folder / "other"), folder / "other");
    const auto remembered = samples_of(batch(in, out), out);
    ASSERT_EQ(again.size(), 2U);
    ASSERT_EQ(remembered.size(), 2U);
    for (std::size_t i = 0; i < remembered.size(); ++i) {
        const auto& a = again[i].samples;
        const auto& b = remembered[i].samples;
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
    write_text(out / temporary_folder / ".flightwatt-0123456789abcdef", "time_s,po");
    expect_redone({});
}

TEST_F(BatchOfTwo, LeavesOtherFilesAlone) {
    const std::vector<std::string> names{
        "flights/notes.txt",  "flights/series.csv.backup1", "flights/mine.series.csv",       "flights/mine.record.json",
        "flights.csv.Backup", "model.toml.202611",          "flights/mine.phases.csv.Ab3dEf"};
    for (const auto& name : names) write_text(out / name, "mine");
    expect_redone_beside(names, {});
    std::filesystem::remove(in / "opterra_synthetic_01.data");
    batch(in, out, 2, true);
    for (const auto& name : names) EXPECT_EQ(read_file(out / name), "mine") << name;
}

TEST_F(BatchOfTwo, BelievesNoRecordThatWasChanged) {
    const auto file = flights / "opterra_synthetic_01.record.json";
    const auto text = read_file(file);
    const auto changed = [&](const char* what, const char* into) {
        return std::regex_replace(text, std::regex(what), into, std::regex_constants::format_first_only);
    };
    const std::vector<std::string> all{changed("\"sortie\": 1", "\"sortie\": 0"),
                                       changed("\"sortie\": 1", "\"sortie\": -1"),
                                       changed("\"sortie\": 1", "\"sortie\": 1e9"),
                                       changed("\"sortie\": 1", "\"sortie\": 1e300"),
                                       changed("\"energy_wh\": 0", "\"energy_wh\": 9"),
                                       text.substr(0, text.size() - 2),
                                       text + text};
    for (const auto& damaged : all) {
        ASSERT_NE(damaged, text);
        write_text(file, damaged);
        expect_redone({one});
    }
}

TEST_F(BatchOfTwo, AddsToEarlierRuns) {
    copy_sample(3, folder / "more");
    const auto first = contents(out);
    const auto added = batch(folder / "more", out);
    ASSERT_EQ(added.size(), 3U);
    EXPECT_THAT(done_anew(added), ElementsAre("opterra_synthetic_03"));
    EXPECT_FALSE(added[0].is_of_this_run);
    EXPECT_TRUE(added[2].is_of_this_run);
    // As if all had been given at once.
    copy_sample(3, in);
    std::filesystem::remove_all(folder / "more");
    batch(in, folder / "at once");
    for (const auto& [name, content] : contents(folder / "at once")) {
        if (name != "batch.json" && name.find("_03") == std::string::npos) {
            EXPECT_EQ(read_file(out / name), content) << name;
        }
    }
}

TEST_F(BatchOfTwo, KeepsTheResultsOfALogThatIsGone) {
    const auto before = samples_of(batch(in, out), out).at(0);
    std::filesystem::remove(in / "opterra_synthetic_01.data");
    const auto kept = batch(in, out);
    ASSERT_EQ(kept.size(), 2U);
    EXPECT_TRUE(kept[0].log_is_missing);
    EXPECT_EQ(samples_of(kept, out).at(0).samples.phases[flight::Phase::cruise]->power_w,
              before.samples.phases[flight::Phase::cruise]->power_w);
    EXPECT_EQ(contents(out), whole);
    // What was changed since is not accepted, and not thrown away either.
    auto changed = whole.at("flights/opterra_synthetic_01.record.json");
    changed.replace(changed.find("0."), 2, "9.");
    write_text(flights / "opterra_synthetic_01.record.json", changed);
    const auto excluded = batch(in, out);
    EXPECT_FALSE(excluded[0].record.accepted);
    EXPECT_THAT(excluded[0].record.error, HasSubstr("its log is missing"));
    EXPECT_EQ(read_file(flights / "opterra_synthetic_01.record.json"), changed);
    EXPECT_EQ(read_file(flights / "opterra_synthetic_01.series.csv"),
              whole.at("flights/opterra_synthetic_01.series.csv"));
}

TEST_F(BatchOfTwo, GoesOnAfterALogWithATooLongName) {
    const auto name = std::string(245, 'n');
    copy_sample(1, in, name);
    const auto flights_now = batch(in, out);
    ASSERT_EQ(flights_now.size(), 3U);
    EXPECT_TRUE(flights_now[0].record.accepted) << flights_now[0].record.error;
    EXPECT_TRUE(flights_now[0].record.flight.starts_with(std::string(200, 'n') + "~"));
    EXPECT_THAT(done_anew(batch(in, out)), IsEmpty());
}

TEST_F(BatchOfTwo, GoesOnAfterAFolderThatCannotBeListed) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may list every folder";
    std::filesystem::create_directories(in / "closed");
    std::filesystem::permissions(in / "closed", std::filesystem::perms::none);
    const auto flights_now = batch(in, out);
    std::filesystem::permissions(in / "closed", std::filesystem::perms::owner_all);
    ASSERT_EQ(flights_now.size(), 3U);
    EXPECT_THAT(flights_now[0].record.error, HasSubstr("in/closed: cannot be listed: Permission denied"));
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

TEST_F(BatchOfTwo, DropsALogThatVanishedIfAsked) {
    std::filesystem::remove(in / "opterra_synthetic_01.data");
    const auto flights_now = batch(in, out, 2, true);
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
    EXPECT_THAT(flights_now[0].record.error, HasSubstr("opterra_synthetic_01.data:1: has no telemetry"));
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
    run_batch(find_logs({(folder / "in").string()}), {folder / "out", {}, 3},
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
    EXPECT_EQ(flights[0].selection.flights.at(0).flight, "flight");
    EXPECT_EQ(flights[1].selection.flights.at(0).flight, "flight_2");
    const auto written = folder / "out" / "flights";
    EXPECT_NE(read_file(written / "flight.series.csv"), read_file(written / "flight_2.series.csv"));
    EXPECT_THAT(done_anew(batch(folder / "in", folder / "out")), IsEmpty());
    // A log keeps its name, whatever becomes of the others, until --prune names all as a new batch does.
    const auto tuesday = read_file(written / "flight_2.series.csv");
    std::filesystem::remove_all(folder / "in" / "monday");
    copy_sample(3, folder / "in" / "before monday", "flight");
    EXPECT_THAT(done_anew(batch(folder / "in", folder / "out")), ElementsAre("flight_3"));
    EXPECT_EQ(read_file(written / "flight_2.series.csv"), tuesday);
    batch(folder / "in", folder / "out", 2, true);
    EXPECT_FALSE(std::filesystem::exists(written / "flight_3.series.csv"));
    EXPECT_TRUE(std::filesystem::exists(written / "flight.series.csv"));
    EXPECT_EQ(read_file(written / "flight_2.series.csv"), tuesday);
}

/// A log in `folder` of these texts, one behind the other.
void put_recordings(const std::filesystem::path& folder, const std::string& name, const std::string& text) {
    std::filesystem::remove(copy_sample(1, folder, name));
    write_text(folder / (name + ".data"), text);
}

/// A minute on the ground.
std::string ground() {
    std::string text;
    for (int t = 0; t < 100; ++t)
        text += fmt::format("{0}.0 7 ENERGY 0 12. 0.1 1.{1} 0. 0.\n{0}.5 7 ESTIMATOR 15. 0.\n", t, t % 7);
    return text;
}

TEST(BatchOfRecordings, HasAFlightOfEach) {
    const auto folder = test::scratch_dir();
    const auto in = folder / "in";
    const auto out = folder / "out";
    const auto first = read_file(test::sample(1));
    const auto second = read_file(test::sample(2));
    put_recordings(in, "log", first + second + ground());
    copy_sample(3, in, "other");
    const auto flights = batch(in, out);
    ASSERT_EQ(flights.size(), 3U);
    EXPECT_EQ(flights[1].record.flight, "log@2");
    EXPECT_EQ(flights[1].selection.flights.at(0).flight, "log@2");
    EXPECT_THAT(texts_of(flights[0].record.diagnostics),
                testing::Contains(HasSubstr("recording 3 is not used: has no flight in")));
    EXPECT_EQ(totals_of(flights).rejected_of_this_run, 0U);
    EXPECT_THAT(done_anew(batch(in, out)), IsEmpty());
    const auto stored = read_stored_flights(out);
    ASSERT_EQ(stored.size(), 3U);
    EXPECT_EQ(stored[1].series.flight, "log@2");
    EXPECT_EQ(stored[1].series.tracks, flight::read_flight(test::sample(2)).tracks);
    EXPECT_EQ(samples_of(batch(in, out), out).size(), 3U);
    // A damaged file is made again, together with the others of its log.
    write_text(out / "flights" / "log@2.series.csv", "damaged");
    EXPECT_THAT(done_anew(batch(in, out)), ElementsAre("log", "log@2"));
    put_recordings(in, "log", first);
    EXPECT_THAT(done_anew(batch(in, out)), ElementsAre("log"));
    EXPECT_FALSE(std::filesystem::exists(out / "flights" / "log@2.series.csv"));
}

TEST(BatchOfRecordings, DropsAllOfALog) {
    const auto folder = test::scratch_dir();
    put_recordings(folder / "in", "log", read_file(test::sample(1)) + read_file(test::sample(2)));
    copy_sample(3, folder / "in", "other");
    batch(folder / "in", folder / "out");
    std::filesystem::remove(folder / "in" / "log.data");
    EXPECT_EQ(batch(folder / "in", folder / "out").size(), 3U) << "kept, its log is missing";
    EXPECT_EQ(batch(folder / "in", folder / "out", 2, true).size(), 1U);
    for (const auto& entry : std::filesystem::directory_iterator(folder / "out" / "flights"))
        EXPECT_THAT(entry.path().filename().string(), testing::StartsWith("other."));
}

TEST(BatchOfRecordings, IsUsableWithoutAFlightInTheFirst) {
    const auto folder = test::scratch_dir();
    put_recordings(folder / "in", "log", ground() + read_file(test::sample(2)) + read_file(test::sample(3)));
    const auto flights = batch(folder / "in", folder / "out");
    ASSERT_EQ(flights.size(), 3U);
    EXPECT_FALSE(flights[0].record.accepted);
    EXPECT_THAT(flights[0].record.error, HasSubstr("recording 1: has no flight in"));
    EXPECT_EQ(flights[2].record.flight, "log@3");
    EXPECT_EQ(totals_of(flights).accepted, 2U);
    EXPECT_EQ(totals_of(flights).rejected_of_this_run, 0U);
    EXPECT_THAT(done_anew(batch(folder / "in", folder / "out")), IsEmpty());
}

TEST(Batch, ReadsTheNamedAircraft) {
    const auto folder = test::scratch_dir();
    copy_sample(1, folder / "in");
    const auto logs = find_logs({(folder / "in").string()});
    const auto silent = [](std::size_t, std::size_t, const BatchFlight&) {};
    const auto right = run_batch(logs, {folder / "out", "7", 1}, silent);
    EXPECT_TRUE(right[0].record.accepted);
    const auto wrong = run_batch(logs, {folder / "out", "9", 1}, silent);
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
    const auto flights = batch(folder / "in", folder / "out");
    EXPECT_THAT(done_anew(flights), ElementsAre("bad\xFF", "good\xFF"));
    const auto catalogue = test::text_of(catalogue_csv(flights));
    EXPECT_EQ(catalogue.find(",true,false,"), std::string::npos) << "complete phases are used\n" << catalogue;
    const auto first = contents(folder / "out");
    EXPECT_THAT(done_anew(batch(folder / "in", folder / "out")), IsEmpty());
    EXPECT_EQ(contents(folder / "out"), first);
}

}  // namespace
}  // namespace flightwatt::batch

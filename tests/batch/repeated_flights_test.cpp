#include "base/error.h"
#include "batch/batch_run.h"
#include "helpers/cut_logs.h"
#include "helpers/sample_logs.h"

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

using test::batch;
using test::copy_sample;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Finds and excludes them.
std::vector<DuplicateFlight> copies_of(BatchFlights& flights, const std::filesystem::path& out) {
    const auto repeated = find_duplicates(flights, out);
    exclude_duplicates(flights, repeated);
    return repeated.copies;
}

TEST(RepeatedFlights, UsesAFlightOnceUnderWhateverName) {
    const auto folder = test::scratch_dir();
    copy_sample(1, folder / "in", "a");
    copy_sample(1, folder / "in", "b");
    copy_sample(2, folder / "in", "c");
    auto flights = batch(folder / "in", folder / "out");
    EXPECT_THAT(copies_of(flights, folder / "out"), ElementsAre(DuplicateFlight{"b", "a", true}));
    EXPECT_THAT(flights[1].selection.flights, IsEmpty());
    EXPECT_EQ(to_string(flights[1].selection.exclusions.back()),
              "b: it is excluded from the fit: it is the same flight as a, which is used");
    EXPECT_EQ(flights[2].selection.flights.size(), 1U);
    // Rather that of which the log is there.
    std::filesystem::remove(folder / "in" / "a.data");
    flights = batch(folder / "in", folder / "out");
    EXPECT_THAT(copies_of(flights, folder / "out"), ElementsAre(DuplicateFlight{"a", "b", true}));
}

/// What another receiver made of a log: it lost every nth line.
void lose_lines(const std::filesystem::path& log, std::size_t every) {
    std::string text;
    std::size_t number = 0;
    for (const auto& line : test::lines_of(read_file(log)))
        if (++number < 3 || number % every != 0) text += line;
    write_file_atomically(log, text);
}

TEST(RepeatedFlights, UsesTheBetterOfTwoRecordingsOfAFlight) {
    const auto folder = test::scratch_dir();
    lose_lines(copy_sample(1, folder / "in", "a"), 4);
    lose_lines(copy_sample(1, folder / "in", "b"), 9);
    auto flights = batch(folder / "in", folder / "out");
    EXPECT_THAT(copies_of(flights, folder / "out"), ElementsAre(DuplicateFlight{"a", "b", true}));
    // What has its definitions is used, however few its lines.
    std::filesystem::remove(folder / "in" / "b.log");
    flights = batch(folder / "in", folder / "out");
    EXPECT_THAT(copies_of(flights, folder / "out"), ElementsAre(DuplicateFlight{"b", "a", true}));
}

TEST(RepeatedFlights, WarnsOfTwoRecordingsThatShareLittle) {
    const auto folder = test::scratch_dir();
    const auto text = read_file(test::sample(1));
    for (const auto* name : {"a", "b"}) copy_sample(1, folder / "in", name);
    const auto first = test::cut_log(text, 480.0);
    write_file_atomically(folder / "in" / "a.data", first.before);
    const auto rest = test::cut_log(text, 350.0);
    write_file_atomically(folder / "in" / "b.data",
                          text.substr(0, text.find('\n') + 1) + fmt::format("{}", fmt::join(rest.after, "")));
    auto flights = batch(folder / "in", folder / "out");
    EXPECT_THAT(copies_of(flights, folder / "out"), IsEmpty());
    EXPECT_THAT(flights[0].record.warnings.back() + flights[1].record.warnings.back(),
                HasSubstr("of one flight both, less than half of either: it counts twice"));
}

TEST(RepeatedFlights, KnowsThatFlightsAreOfSeveralAircraft) {
    const auto folder = test::scratch_dir();
    for (int number = 1; number <= 2; ++number) copy_sample(number, folder / "in");
    auto flights = batch(folder / "in", folder / "out");
    EXPECT_EQ(mixed_aircraft_reason(flights), "");
    auto first = flights[0];
    first.record.aircraft_id = "8";
    flights[0] = first;
    EXPECT_THAT(mixed_aircraft_reason(flights), HasSubstr("; 8 Opterra_synthetic (SYNTHETIC): opterra_synthetic_01"));
    first.selection.flights.clear();
    flights[0] = first;
    EXPECT_EQ(mixed_aircraft_reason(flights), "") << "what is not fitted does not count";
}

}  // namespace
}  // namespace flightwatt::batch

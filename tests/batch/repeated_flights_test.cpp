#include "batch/batch_run.h"
#include "helpers/sample_logs.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

using test::batch;
using test::copy_sample;
using testing::ElementsAre;
using testing::IsEmpty;

/// Finds and excludes them.
std::vector<DuplicateFlight> copies_of(BatchFlights& flights) {
    auto copies = find_duplicates(flights);
    exclude_duplicates(flights, copies);
    return copies;
}

TEST(RepeatedFlights, UsesAFlightOnceUnderWhateverName) {
    const auto folder = test::scratch_dir();
    copy_sample(1, folder / "in", "a");
    copy_sample(1, folder / "in", "b");
    copy_sample(2, folder / "in", "c");
    auto flights = batch(folder / "in", folder / "out");
    EXPECT_THAT(copies_of(flights), ElementsAre(DuplicateFlight{"b", "a", true}));
    EXPECT_THAT(flights[1].selection.flights, IsEmpty());
    EXPECT_EQ(to_string(flights[1].selection.exclusions.back()),
              "b: it is not used in the fit: it is the same flight as a, which is used");
    EXPECT_EQ(flights[2].selection.flights.size(), 1U);
    // Rather that of which the log is there.
    std::filesystem::remove(folder / "in" / "a.data");
    flights = batch(folder / "in", folder / "out");
    EXPECT_THAT(copies_of(flights), ElementsAre(DuplicateFlight{"a", "b", true}));
}

TEST(RepeatedFlights, UsesTheCopyWithItsDefinitions) {
    const auto folder = test::scratch_dir();
    for (const auto* name : {"a", "b"}) copy_sample(1, folder / "in", name);
    std::filesystem::remove(folder / "in" / "a.log");
    auto flights = batch(folder / "in", folder / "out");
    EXPECT_THAT(copies_of(flights), ElementsAre(DuplicateFlight{"a", "b", true}));
}

TEST(RepeatedFlights, LeavesHoverOutWhereAnotherFlightOfTheAircraftIsOnTheWing) {
    const auto folder = test::scratch_dir();
    for (int number = 1; number <= 2; ++number) copy_sample(number, folder / "in");
    auto flights = batch(folder / "in", folder / "out");
    flights[0].selection.flights.at(0).only_hovers = true;
    const auto all = flights;
    EXPECT_THAT(exclude_hover(flights, {"opterra_synthetic_01"}), IsEmpty());
    ASSERT_EQ(exclude_hover(flights, {}).size(), 1U);
    EXPECT_THAT(flights[0].selection.flights, IsEmpty());
    EXPECT_EQ(flights[0].selection.exclusions.back().reason, mechanical::hover_reason());
    EXPECT_EQ(flights[1].selection.flights.size(), 1U);
    auto of_others = all;
    of_others[0].record.aircraft_id = "8";
    EXPECT_THAT(exclude_hover(of_others, {}), IsEmpty()) << "alone of its aircraft it hovers throughout";
}

TEST(RepeatedFlights, KnowsThatFlightsAreOfSeveralAircraft) {
    const auto folder = test::scratch_dir();
    for (int number = 1; number <= 2; ++number) copy_sample(number, folder / "in");
    auto flights = batch(folder / "in", folder / "out");
    EXPECT_EQ(group_aircraft(fitted_aircraft(flights)).size(), 1U);
    flights[0].record.aircraft_id = "8";
    const auto fitted = fitted_aircraft(flights);
    const auto groups = group_aircraft(fitted);
    EXPECT_EQ(list_aircraft(groups, fitted),
              "8 Opterra_synthetic (SYNTHETIC): opterra_synthetic_01; "
              "7 Opterra_synthetic (SYNTHETIC): opterra_synthetic_02");
    EXPECT_THAT(keep_aircraft(flights, groups[1], fitted), ElementsAre("opterra_synthetic_01"));
    EXPECT_TRUE(flights[0].is_of_other_aircraft);
    EXPECT_THAT(flights[0].selection.flights, IsEmpty());
    EXPECT_EQ(group_aircraft(fitted_aircraft(flights)).size(), 1U) << "what is not fitted does not count";
}

}  // namespace
}  // namespace flightwatt::batch

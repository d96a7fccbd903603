#include "batch/batch_flights.h"

#include "base/error.h"
#include "helpers/test_paths.h"

#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

using testing::ElementsAre;

BatchFlight flight_of(const std::string& name) {
    BatchFlight flight;
    auto& record = flight.record;
    record.flight = name;
    record.log = "in/" + name;
    record.fingerprint = "f";
    record.results = "r";
    record.accepted = true;
    record.error = "none";
    record.is_of_other_aircraft = true;
    record.aircraft_id = "7";
    record.aircraft_name = "x";
    record.power_source = "ENERGY.power";
    record.current_origin = "measured";
    RecordedPhase phase{2, flight::Phase::landing, 1.0, 2.5, 0.25, 0.5, false, {}};
    phase.statistics = {9, 30.0, 0.0125, 0.5, 3, 1.75};
    record.phases = {phase, {}};
    record.warnings = {"one", "", std::string("a\0b", 3)};
    record.power_faults = {"fault"};
    record.no_power_reason = "lacks";
    record.not_fitted_reason = "why";
    record.content.has_definitions = false;
    record.content.samples = 77;
    flight.was_up_to_date = true;
    flight.is_of_this_run = false;
    flight.log_is_missing = true;
    SelectedSortie sortie{name + "#2", {}};
    sortie.phases[flight::Phase::cruise] = true;
    flight.selection.flights = {sortie};
    flight.selection.exclusions = {{name, flight::Phase::cruise, "short"}, {name, std::nullopt, "all"}};
    return flight;
}

TEST(BatchFlights, KeepsWhatBecameOfALog) {
    const auto folder = test::scratch_dir();
    BatchFlights flights(2, folder);
    flights.put(1, flight_of("b"));
    flights.put(0, flight_of("a"));
    const auto flight = flights[1];
    const auto& record = flight.record;
    EXPECT_THAT((std::vector{record.flight, record.log, record.fingerprint, record.results, record.error,
                             record.aircraft_id, record.aircraft_name, record.power_source, record.current_origin,
                             record.no_power_reason, record.not_fitted_reason}),
                ElementsAre("b", "in/b", "f", "r", "none", "7", "x", "ENERGY.power", "measured", "lacks", "why"));
    EXPECT_TRUE(record.accepted && record.is_of_other_aircraft);
    EXPECT_THAT(record.warnings, ElementsAre("one", "", std::string("a\0b", 3)));
    EXPECT_THAT(record.power_faults, ElementsAre("fault"));
    EXPECT_TRUE(record.content == flight_of("b").record.content);
    ASSERT_EQ(record.phases.size(), 2U);
    const auto& phase = record.phases[0];
    EXPECT_EQ(phase.sortie, 2U);
    EXPECT_EQ(phase.phase, flight::Phase::landing);
    EXPECT_THAT((std::vector{phase.start_s, phase.end_s, phase.start_gap_s, phase.end_gap_s}),
                ElementsAre(1.0, 2.5, 0.25, 0.5));
    EXPECT_FALSE(phase.complete);
    EXPECT_EQ(phase.statistics.samples, 9U);
    EXPECT_EQ(phase.statistics.mean_power_w, 30.0);
    EXPECT_EQ(phase.statistics.energy_wh, 0.0125);
    EXPECT_EQ(phase.statistics.counter_energy_wh, 0.5);
    EXPECT_EQ(phase.statistics.gaps, 3U);
    EXPECT_EQ(phase.statistics.max_gap_s, 1.75);
    EXPECT_EQ(record.phases[1].statistics.counter_energy_wh, std::nullopt);
    EXPECT_TRUE(flight.was_up_to_date && !flight.is_of_this_run && flight.log_is_missing);
    ASSERT_EQ(flight.selection.flights.size(), 1U);
    EXPECT_EQ(flight.selection.flights[0].flight, "b#2");
    EXPECT_THAT(flight.selection.flights[0].phases.values, ElementsAre(false, true, false));
    ASSERT_EQ(flight.selection.exclusions.size(), 2U);
    EXPECT_EQ(flight.selection.exclusions[0].phase, flight::Phase::cruise);
    EXPECT_EQ(flight.selection.exclusions[1].phase, std::nullopt);
    EXPECT_EQ(flight.selection.exclusions[1].reason, "all");
}

TEST(BatchFlights, LeavesNoFileAndTellsWhatIsNotThere) {
    const auto folder = test::scratch_dir();
    {
        BatchFlights flights(2, folder);
        flights.put(0, flight_of("a"));
        EXPECT_THAT(std::filesystem::is_empty(folder), true);
        EXPECT_THROW(flights[1], OutputError);
        EXPECT_THROW(flights[2], std::out_of_range);
    }
    EXPECT_THROW(BatchFlights(1, folder / "nowhere"), OutputError);
}

TEST(BatchFlights, TakesThemFromManyThreadsAndMoreThanOnce) {
    constexpr std::size_t count = 400;
    BatchFlights flights(count, test::scratch_dir());
    const auto put = [&](std::size_t first) {
        for (std::size_t i = first; i < count; i += 4) {
            flights.put(i, flight_of("old"));
            flights.put(i, flight_of(std::to_string(i)));
        }
    };
    {
        std::vector<std::jthread> threads;
        for (std::size_t first = 0; first < 4; ++first) threads.emplace_back(put, first);
    }
    std::size_t number = 0;
    for (const auto& flight : flights) EXPECT_EQ(flight.record.flight, std::to_string(number++));
    EXPECT_EQ(number, count);
}

}  // namespace
}  // namespace flightwatt::batch

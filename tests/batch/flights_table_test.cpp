#include "base/csv.h"
#include "batch/batch_run.h"
#include "helpers/sample_logs.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

RecordedPhase phase(std::size_t sortie, flight::Phase which, double start_s, double end_s) {
    RecordedPhase recorded{sortie, which, start_s, end_s, 0.5, 0.5, true, {}};
    recorded.statistics.samples = 10;
    recorded.statistics.mean_power_w = 25.0;
    recorded.statistics.energy_wh = 0.5;
    recorded.statistics.counter_energy_wh = 0.25;
    return recorded;
}

/// Two sorties; of the second one, the cruise alone goes into a fit, and the landing is cut off.
BatchFlight two_sorties() {
    BatchFlight flight;
    flight.record.flight = "twice, \"up\"";
    flight.record.accepted = true;
    flight.record.aircraft_id = "7";
    flight.record.aircraft_name = "synthetic_x";
    flight.record.power_source = "ENERGY.power";
    flight.record.phases = {phase(1, flight::Phase::takeoff, 10, 30), phase(2, flight::Phase::cruise, 100, 400),
                            phase(2, flight::Phase::landing, 400, 450)};
    flight.record.phases[2].complete = false;
    flight.record.phases[2].statistics.counter_energy_wh.reset();
    SelectedSortie first{flight.record.flight, {}};
    first.phases[flight::Phase::takeoff] = true;
    SelectedSortie second{flight.record.flight + "#2", {}};
    second.phases[flight::Phase::cruise] = true;
    flight.selection.flights = {first, second};
    return flight;
}

BatchFlight rejected_flight() {
    BatchFlight flight;
    flight.record.flight = "bad";
    flight.record.error = "bad.data:1: has no telemetry, \"none\"";
    return flight;
}

BatchFlights both_flights() { return {two_sorties(), rejected_flight()}; }

TEST(Catalogue, HasARowAPhaseAndARejectedLog) {
    const auto flights = both_flights();
    const auto table = parse_csv(test::text_of(catalogue_csv(flights)), "flights.csv");
    const std::vector<std::string> first(table.columns.begin(), table.columns.begin() + 14);
    EXPECT_THAT(first, testing::ElementsAre("flight", "sortie", "phase", "start_s", "end_s", "duration_s", "samples",
                                            "mean_power_w", "energy_wh", "counter_energy_wh", "gaps", "longest_gap_s",
                                            "complete", "used"));
    ASSERT_EQ(table.rows.size(), 4U);
    const auto cell = [&](std::size_t row, const char* column) {
        return table.rows[row].cells[column_index(table, column)].text;
    };
    EXPECT_EQ(cell(0, "flight"), "twice, \"up\"");
    EXPECT_EQ(cell(0, "sortie"), "1");
    EXPECT_EQ(cell(0, "phase"), "takeoff");
    EXPECT_EQ(cell(0, "duration_s"), "20");
    EXPECT_EQ(cell(0, "counter_energy_wh"), "0.25");
    EXPECT_EQ(cell(0, "used"), "true");
    EXPECT_EQ(cell(1, "sortie"), "2");
    EXPECT_EQ(cell(1, "used"), "true");
    EXPECT_EQ(cell(2, "used"), "false");
    EXPECT_EQ(cell(2, "complete"), "false");
    EXPECT_EQ(cell(2, "counter_energy_wh"), "");
    EXPECT_EQ(cell(0, "synthetic"), "true");
    EXPECT_EQ(cell(3, "synthetic"), "");
    EXPECT_EQ(cell(3, "flight"), "bad");
    EXPECT_EQ(cell(3, "phase"), "");
    EXPECT_EQ(cell(3, "used"), "false");
    EXPECT_EQ(cell(3, "error"), "bad.data:1: has no telemetry, \"none\"");
}

TEST(FlightsTable, HasARowASortie) {
    const auto table = flights_table(both_flights(), 2);
    ASSERT_EQ(table.rows.size(), 3U);
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
    EXPECT_THAT(table.rows[0],
                testing::ElementsAre("twice, \"up\"", "7 synthetic_x (SYNTHETIC)", "1", "20", "-", "-", "25.0", "-",
                                     "-", "0.500", "0.250", "10", "0", "0.0", "0", "1 of 3"));
    // An asterisk: the log ends in the landing. Its counter is not known, so neither is the sortie's.
    EXPECT_THAT(table.rows[1],
                testing::ElementsAre("twice, \"up\"", "7 synthetic_x (SYNTHETIC)", "2", "-", "300", "50*", "-", "25.0",
                                     "25.0", "1.000", "-", "20", "0", "0.0", "0", "1 of 3"));
    EXPECT_EQ(table.rows[2][0], "bad");
    EXPECT_EQ(table.rows[2][2], "-");
}

}  // namespace
}  // namespace flightwatt::batch

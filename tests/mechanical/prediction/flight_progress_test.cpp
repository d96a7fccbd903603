#include "mechanical/prediction/flight_progress.h"

#include "base/error.h"
#include "flight/cut_series.h"
#include "flight/flight_reader.h"
#include "flight/phase_statistics.h"
#include "flight/segmentation.h"
#include "helpers/test_paths.h"

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

flight::FlightSeries sample_flight() {
    return flight::read_flight(test::source_dir() / "logs" / "opterra_synthetic_01.data");
}

TEST(CutSeries, LeavesNothingLater) {
    const auto cut = cut_series(sample_flight(), 300.0);
    EXPECT_LE(cut.time_s.back(), 300.0);
    EXPECT_GT(cut.time_s.back(), 290.0);
    EXPECT_EQ(cut.power_w.size(), cut.time_s.size());
    EXPECT_EQ(cut.energy_wh.size(), cut.time_s.size());
    EXPECT_LE(cut.altitude_track.time_s.back(), 300.0);
    EXPECT_LE(cut.witnesses.block.time_s.back(), 300.0);
    EXPECT_EQ(cut.altitude_track.value.size(), cut.altitude_track.time_s.size());
}

TEST(FlownSoFar, CountsFromLiftOff) {
    const auto series = sample_flight();
    const auto flown = flown_so_far(series, {300.0, 0.0});
    const auto phases = segment(series).sorties.at(0).phases;
    EXPECT_NEAR(flown.lift_off_s, phases.at(0).start.time_s, 1.0);
    EXPECT_NEAR(flown.cruise_start_s, phases.at(1).start.time_s, 1.0);
    EXPECT_NEAR(flown.until_s - flown.lift_off_s, 300.0, 1.0);
    EXPECT_NEAR(flown.energy_wh, integrated_energy_wh(series, flown.lift_off_s, flown.until_s), 0.01);
}

TEST(FlownSoFar, IsTheSameOnTheLogsClock) {
    const auto series = sample_flight();
    const auto by_flight = flown_so_far(series, {300.0, 0.0});
    const auto by_log = flown_so_far(series, {std::nullopt, by_flight.until_s});
    EXPECT_EQ(by_flight.energy_wh, by_log.energy_wh);
    EXPECT_EQ(by_flight.cruise_start_s, by_log.cruise_start_s);
}

/// The later part of the log changes nothing, bit by bit.
void expect_no_hindsight(const flight::FlightSeries& series, double since_s) {
    const auto whole = flown_so_far(series, {since_s, 0.0});
    const auto cut = flown_so_far(cut_series(series, whole.until_s), {since_s, 0.0});
    EXPECT_EQ(whole.until_s, cut.until_s);
    EXPECT_EQ(whole.lift_off_s, cut.lift_off_s);
    EXPECT_EQ(whole.cruise_start_s, cut.cruise_start_s);
    EXPECT_EQ(whole.energy_wh, cut.energy_wh);
    EXPECT_EQ(whole.airspeed_cubed_m3_per_s3, cut.airspeed_cubed_m3_per_s3);
}

TEST(FlownSoFar, HasNoHindsight) {
    for (const double since_s : {70.0, 300.0, 500.0}) expect_no_hindsight(sample_flight(), since_s);
}

TEST(FlownSoFar, HasNoHindsightOnRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto* name : {"20_07_03__12_17_45", "20_07_05__10_26_44", "20_07_10__06_53_03"}) {
        const auto series = flight::read_flight(test::shared_dir() / "flights" / (std::string(name) + ".data"));
        for (const double since_s : {120.0, 300.0, 500.0}) expect_no_hindsight(series, since_s);
    }
}

TEST(FlownSoFar, RefusesMomentsOutsideOfTheCruise) {
    const auto series = sample_flight();
    EXPECT_THROW(flown_so_far(series, {std::nullopt, 40.0}), NoAnswerError);   // on the ground
    EXPECT_THROW(flown_so_far(series, {std::nullopt, 74.0}), NoAnswerError);   // climbing
    EXPECT_THROW(flown_so_far(series, {std::nullopt, 740.0}), NoAnswerError);  // landed
    EXPECT_THROW(flown_so_far(series, {5000.0, 0.0}), NoAnswerError);          // the log ends before
    EXPECT_THROW(flown_so_far(series, {300.0, 0.0}, 1), NoAnswerError);        // no second sortie
}

}  // namespace
}  // namespace flightwatt::mechanical

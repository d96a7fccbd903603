#include "mechanical/flight_progress.h"

#include "base/error.h"
#include "flight/flight_series.h"
#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "flight/segment.h"
#include "helpers/flight_progress.h"
#include "helpers/flown_points.h"
#include "helpers/test_paths.h"

#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using test::progress_at;

flight::FlightSeries sample_flight() {
    return flight::read_flight(test::source_dir() / "logs" / "opterra_synthetic_01.data");
}

FlightProgress progress_since(const flight::FlightSeries& series, double since_s, std::size_t sortie = 0) {
    return progress_at(series, log_time_after_lift_off(series, since_s, sortie), sortie);
}

TEST(FlightProgress, CountsFromLiftOff) {
    const auto series = sample_flight();
    const auto flown = progress_since(series, 300.0);
    const auto phases = segment(select_tracks(series)).sorties.at(0).phases;
    EXPECT_NEAR(flown.lift_off_s, phases.at(0).start.time_s, 1.0);
    EXPECT_NEAR(flown.cruise_start_s, phases.at(1).start.time_s, 1.0);
    EXPECT_NEAR(flown.until_s - flown.lift_off_s, 300.0, 1.0);
    EXPECT_NEAR(flown.energy_wh, integrated_energy_wh(select_tracks(series).power_w, flown.lift_off_s, flown.until_s),
                0.01);
}

TEST(FlightProgress, IsTheSameOnTheLogsClock) {
    const auto series = sample_flight();
    const auto by_flight = progress_since(series, 300.0);
    const auto by_log = progress_at(series, by_flight.until_s);
    EXPECT_EQ(by_flight.energy_wh, by_log.energy_wh);
    EXPECT_EQ(by_flight.cruise_start_s, by_log.cruise_start_s);
}

/// The later part of the log changes nothing, bit by bit.
void expect_no_hindsight(const flight::FlightSeries& series, double since_s) {
    const auto whole = progress_since(series, since_s);
    const auto cut = progress_since(truncate_series(series, whole.until_s), since_s);
    EXPECT_EQ(whole.until_s, cut.until_s);
    EXPECT_EQ(whole.lift_off_s, cut.lift_off_s);
    EXPECT_EQ(whole.cruise_start_s, cut.cruise_start_s);
    EXPECT_EQ(whole.energy_wh, cut.energy_wh);
    ASSERT_EQ(whole.motion.bins.size(), cut.motion.bins.size());
    for (std::size_t i = 0; i < whole.motion.bins.size(); ++i) {
        EXPECT_EQ(whole.motion.bins[i].power_w, cut.motion.bins[i].power_w);
        EXPECT_EQ(whole.motion.bins[i].values.values, cut.motion.bins[i].values.values);
    }
}

TEST(FlightProgress, HasNoHindsight) {
    for (const double since_s : {70.0, 300.0, 500.0}) expect_no_hindsight(sample_flight(), since_s);
}

TEST(FlightProgress, HasNoHindsightOnRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto* name : {"20_07_03__12_17_45", "20_07_05__10_26_44", "20_07_10__06_53_03"}) {
        const auto series = flight::read_flight(test::shared_dir() / "flights" / (std::string(name) + ".data"));
        for (const double since_s : {120.0, 300.0, 500.0}) expect_no_hindsight(series, since_s);
    }
}

TEST(FlightProgress, IsATakeoffUntilTheHeightIsHeld) {
    const auto series = sample_flight();
    const auto climbing = progress_at(series, 74.0);
    EXPECT_EQ(climbing.cruise_s(), 0.0);
    const double flown_s = 74.0 - climbing.lift_off_s;
    const auto takeoff = climbing.phases[flight::Phase::takeoff];
    EXPECT_GT(takeoff.duration_s, 0.8 * flown_s) << "90 % of the height so far";
    EXPECT_LT(takeoff.duration_s, flown_s);
    EXPECT_NEAR(takeoff.energy_wh / climbing.energy_wh, takeoff.duration_s / flown_s, 0.05);
    const double cruise_start_s = progress_at(series, 300.0).cruise_start_s;
    const auto level = progress_at(series, cruise_start_s + 25.0);
    EXPECT_EQ(level.cruise_s(), 0.0) << "25 s are not 30";
    EXPECT_NEAR(level.phases[flight::Phase::takeoff].duration_s, cruise_start_s - level.lift_off_s, 2.0)
        << "without the level flight behind it, which takes less power";
    EXPECT_NEAR(progress_at(series, cruise_start_s + 35.0).cruise_s(), 35.0, 2.0);
}

TEST(FlightProgress, IsACruiseOnceTheHeightIsHeldAsLongAsTheClimbTook) {
    const std::vector<test::Point> points{{0, 0, 0},    {38, 0, 0},   {39, 0, 90},   {40, 0, 90},
                                          {55, 60, 90}, {56, 60, 60}, {300, 60, 60}, {320, 0, 10}};
    const auto series = test::series_of(points);
    const auto climbed = progress_at(series, 200.0);
    const double climb_s = climbed.cruise_start_s - climbed.lift_off_s;
    ASSERT_GT(climb_s, 10.0);
    ASSERT_LT(climb_s, 20.0);
    EXPECT_EQ(progress_at(series, climbed.cruise_start_s + climb_s - 2.0).cruise_s(), 0.0);
    EXPECT_GT(progress_at(series, climbed.cruise_start_s + climb_s + 2.0).cruise_s(), 0.0);
}

TEST(FlightProgress, RefusesMomentsOutsideOfTheFlight) {
    const auto series = sample_flight();
    EXPECT_THROW(progress_at(series, 40.0), NoResultError);         // on the ground
    EXPECT_THROW(progress_at(series, 740.0), NoResultError);        // landed
    EXPECT_THROW(progress_since(series, 5000.0), NoResultError);    // the log ends before
    EXPECT_THROW(progress_since(series, 300.0, 1), NoResultError);  // no second sortie
}

}  // namespace
}  // namespace flightwatt::mechanical

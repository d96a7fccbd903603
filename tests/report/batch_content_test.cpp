// What the report takes from a batch's folder.

#include "report/batch_content.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "flight/select.h"
#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

TEST(BatchContent, HoldsTheFlightsAndTheFitThatTheBatchStored) {
    const auto folder = test::scratch_dir();
    const auto logs = test::shell_quoted(test::source_dir() / "logs");
    const auto run = test::run_shell("echo nothing > broken.data; flightwatt batch " + logs +
                                         "/opterra_synthetic_0[1-3].data broken.data -o out "
                                         "--exclude opterra_synthetic_02",
                                     folder);
    ASSERT_EQ(run.code, 3) << run.err;
    const auto content = read_batch_content(folder / "out");
    ASSERT_EQ(content.flights.size(), 4U);
    ASSERT_TRUE(content.fit);
    EXPECT_EQ(content.measured.size(), 2U);
    for (const auto& flight : content.flights) {
        EXPECT_EQ(flight.rejected.empty(), flight.name != "broken") << flight.name;
        EXPECT_EQ(flight.exclusions.empty(), flight.name != "opterra_synthetic_02") << flight.name;
        EXPECT_EQ(flight.phases.sorties.size(), flight.name == "broken" ? 0U : 1U) << flight.name;
    }
    EXPECT_FALSE(content.fit->bands[flight::Phase::cruise].time_s.empty());
}

TEST(BatchContent, HasNoFitWhereTheBatchCouldNotFit) {
    const auto folder = test::scratch_dir();
    const auto run = test::run_shell("echo nothing > broken.data; flightwatt batch broken.data -o out", folder);
    EXPECT_NE(run.code, 0);
    const auto content = read_batch_content(folder / "out");
    EXPECT_FALSE(content.fit);
    EXPECT_TRUE(content.measured.empty());
}

/// The log of a VTOL that is on its wing (w) or hovers (h), a sortie after the other.
std::string vtol_log(const std::string& name, const std::string& sorties, int aircraft_id = 7) {
    auto text = fmt::format(
        "# format = 1\n# flight = \"{}\"\n# aircraft_id = \"{}\"\n# aircraft_name = \"VTOL\"\n"
        "# firmware = \"fixedwing\"\ntime_s,power_w,voltage_v,current_a,altitude_m,throttle_percent,vtol_state\n",
        name, aircraft_id);
    int time_s = 0;
    for (const char flown : sorties) {
        for (int i = 0; i < 300; ++i, ++time_s) {
            const double height_m = std::clamp(3.0 * std::min(i - 30, 270 - i), 0.0, 30.0);
            const bool is_on_wing = flown == 'w' && height_m == 30.0;
            const double power_w = height_m == 0.0 ? 2.0 : (is_on_wing ? 100.0 : 300.0) + i % 7;
            text += fmt::format("{},{},24,{},{},{},{}\n", time_s, power_w, power_w / 24.0, height_m,
                                height_m > 0.0 ? 50 : 0, is_on_wing ? 4 : 3);
        }
    }
    return text;
}

/// The page left the log out of the battery, and called it not fitted, though its first sortie was.
TEST(BatchContent, OnlyTheHoverOfAVtolIsNotFitted) {
    const auto folder = test::scratch_dir();
    write_file_atomically(folder / "wing.csv", vtol_log("wing", "wh"));
    write_file_atomically(folder / "hover#a.csv", vtol_log("hover#a", "h"));
    const auto run = test::run_shell("flightwatt batch wing.csv 'hover#a.csv' -o out", folder);
    ASSERT_EQ(run.code, 0) << run.err;
    const auto content = read_batch_content(folder / "out");
    ASSERT_EQ(content.flights.size(), 2U);
    for (const auto& flight : content.flights) {
        EXPECT_EQ(fitted_part(flight), flight.name == "wing" ? "in part" : "no") << flight.name;
        EXPECT_EQ(flight.unusable_power, "") << "the battery is that of all";
        EXPECT_EQ(flight.exclusions.size(), 1U) << flight.name;
    }
}

/// The page had it of a hover in the fit that other flights of its aircraft are on the wing.
TEST(BatchContent, TheHoverOfAnotherVtolIsFitted) {
    const auto folder = test::scratch_dir();
    write_file_atomically(folder / "wing.csv", vtol_log("wing", "w"));
    write_file_atomically(folder / "hover.csv", vtol_log("hover", "h", 8));
    const auto run = test::run_shell("flightwatt batch wing.csv hover.csv --mix-aircraft -o out", folder);
    ASSERT_EQ(run.code, 0) << run.err;
    const auto content = read_batch_content(folder / "out");
    EXPECT_EQ(content.measured.size(), 2U);
    for (const auto& flight : content.flights) EXPECT_EQ(fitted_part(flight), "all") << flight.name;
}

TEST(FittedPart, FollowsExclusionsAndThePowerRecord) {
    ReportFlight flight;
    EXPECT_EQ(fitted_part(flight), "all");
    flight.exclusions = {"cruise is excluded: the log ends inside of it"};
    EXPECT_EQ(fitted_part(flight), "in part");
    flight.is_fitted = false;
    EXPECT_EQ(fitted_part(flight), "no");
    flight.is_fitted = true;
    flight.unusable_power = "its power does not change at all";
    EXPECT_EQ(fitted_part(flight), "no");
}

flight::Track track(const std::string& name, std::vector<double> time_s, std::vector<double> value) {
    return {name, "TEST", "", 0.0, std::move(time_s), std::move(value)};
}

/// In the air from 10 to 30 s, along a square of 100 m a side in between.
ReportFlight square_flight() {
    ReportFlight flight;
    flight.name = "20_07_03__12_17_45";
    flight::FlightSeries series;
    series.tracks = {track("altitude_m", {0, 10, 20, 30, 40}, {200, 200, 260, 205, 200}),
                     track("power_w", {0, 10, 20, 30, 40}, {0, 36, 36, 36, 0}),
                     track("east_m", {0, 10, 15, 20, 25, 30, 40}, {-500, 0, 100, 100, 0, 0, 900}),
                     track("north_m", {0, 10, 15, 20, 25, 30, 40}, {0, 0, 0, 100, 100, 0, 0})};
    flight.data = select_tracks(series);
    flight::Sortie sortie;
    for (const auto phase : flight::all_phases) {
        flight::PhaseSpan span;
        span.phase = phase;
        span.start.time_s = phase == flight::Phase::takeoff ? 10.0 : phase == flight::Phase::cruise ? 15.0 : 25.0;
        span.end.time_s = phase == flight::Phase::takeoff ? 15.0 : phase == flight::Phase::cruise ? 25.0 : 30.0;
        sortie.phases.push_back(span);
    }
    flight.phases.sorties = {sortie};
    return flight;
}

TEST(FlightFacts, AreThoseOfTheTimeInTheAir) {
    const auto facts = summarize_flight(square_flight());
    EXPECT_EQ(facts.in_air_s, 20.0);
    ASSERT_TRUE(facts.distance_m && facts.height_m && facts.energy_wh);
    EXPECT_DOUBLE_EQ(*facts.distance_m, 400.0);
    EXPECT_DOUBLE_EQ(*facts.height_m, 60.0);
    EXPECT_DOUBLE_EQ(*facts.energy_wh, 36.0 * 20.0 / 3600.0);
    EXPECT_DOUBLE_EQ(facts.mean_power_w[flight::Phase::cruise].value(), 36.0);
    EXPECT_FALSE(facts.air_distance_m) << "no airspeed was measured";
}

TEST(FlightFacts, MeasureTheWayThroughTheAirByAirspeed) {
    auto flight = square_flight();
    flight.data.airspeed_m_per_s = {track("airspeed_m_per_s", {0, 10, 20, 30, 40}, {50, 10, 12, 10, 50})};
    EXPECT_DOUBLE_EQ(summarize_flight(flight).air_distance_m.value(), 220.0) << "11 m/s for 20 s";
}

TEST(FlightFacts, HaveNoCruisePowerWithoutACruise) {
    auto flight = square_flight();
    flight.phases.sorties[0].phases.erase(flight.phases.sorties[0].phases.begin() + 1);
    EXPECT_FALSE(summarize_flight(flight).mean_power_w[flight::Phase::cruise]);
}

TEST(FlightFacts, MeasureDegreesOnTheEarth) {
    auto flight = square_flight();
    flight.data.east_m = flight.data.north_m = {};
    flight.data.latitude_deg = {track("latitude_deg", {10, 30}, {43.0, 43.01})};
    flight.data.longitude_deg = {track("longitude_deg", {10, 30}, {1.0, 1.0})};
    const auto facts = summarize_flight(flight);
    ASSERT_TRUE(facts.distance_m);
    EXPECT_NEAR(*facts.distance_m, 1111.1, 1.0) << "a hundredth of a degree of latitude";
}

TEST(FlightFacts, HaveTheDateOfTheClockOrElseOfTheName) {
    auto flight = square_flight();
    EXPECT_EQ(summarize_flight(flight).date, "2020-07-03 12:17");
    flight.data.start_clock_s = 1593771465.0;
    EXPECT_EQ(summarize_flight(flight).date, "2020-07-03 10:17") << "UTC";
    EXPECT_EQ(summarize_flight(flight).start_clock_s, 1593771465.0);
    flight.data.start_clock_s.reset();
    flight.name = "survey";
    EXPECT_EQ(summarize_flight(flight).date, "");
}

TEST(FlightFacts, SayNothingOfWhatWasNotLogged) {
    auto flight = square_flight();
    flight.data.power_w = flight.data.east_m = flight.data.north_m = {};
    const auto facts = summarize_flight(flight);
    EXPECT_FALSE(facts.distance_m);
    EXPECT_FALSE(facts.energy_wh);
    EXPECT_TRUE(facts.height_m);
}

}  // namespace
}  // namespace flightwatt::report

#include "mechanical/measured_flight.h"

#include "helpers/sample_columns.h"

#include <algorithm>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;

/// A sample a second from 0 to 300 s; the power shows the time.
flight::FlightSeries series_of_300_s() {
    test::SampleColumns series;
    for (int second = 0; second <= 300; ++second) {
        series.time_s.push_back(second);
        series.power_w.push_back(1000.0 + second);
    }
    return test::series_of(series);
}

flight::PhaseSpan span(flight::Phase phase, double start_s, double end_s) {
    flight::PhaseSpan result;
    result.phase = phase;
    result.start.time_s = start_s;
    result.end.time_s = end_s;
    return result;
}

flight::Sortie whole_sortie(double start_s) {
    flight::Sortie sortie;
    sortie.phases = {span(flight::Phase::takeoff, start_s, start_s + 20),
                     span(flight::Phase::cruise, start_s + 20, start_s + 80),
                     span(flight::Phase::landing, start_s + 80, start_s + 100)};
    return sortie;
}

struct Selection {
    std::vector<FlightSamples> flights;
    std::vector<Exclusion> exclusions;
};

Selection select(const std::vector<flight::Sortie>& sorties) {
    flight::FlightPhases phases;
    phases.sorties = sorties;
    for (std::size_t s = 0; s < sorties.size(); ++s) phases.sorties[s].number = s + 1;
    auto measured = extract_flights(select_tracks(series_of_300_s()), phases);
    Selection selection{{}, std::move(measured.exclusions)};
    for (auto& flight : measured.flights) selection.flights.push_back(std::move(flight.samples));
    return selection;
}

/// A VTOL's flights by name, those with an "h" only hover.
std::vector<MeasuredFlight> vtol_flights(const std::vector<std::string>& names) {
    std::vector<MeasuredFlight> flights(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
        flights[i].samples.flight = names[i];
        flights[i].only_hovers = names[i].front() == 'h';
    }
    return flights;
}

/// The mean of a hover of 265 W and a wing's cruise of 58 W was answered as 141 W.
TEST(MeasuredFlights, ThatOnlyHoverAreNotAveragedWithThoseOnTheWing) {
    auto flights = vtol_flights({"h1", "w1", "h2#2", "h#3"});
    const auto excluded = exclude_hover(flights, {"h#3"});
    ASSERT_EQ(excluded.size(), 2U);
    EXPECT_EQ(to_string(excluded[1]),
              "h2#2: it is not used in the fit: it only hovers, and other flights of this aircraft are on the wing");
    ASSERT_EQ(flights.size(), 2U);
    EXPECT_EQ(flights[1].samples.flight, "h#3") << "--keep names it";
    auto all_hover = vtol_flights({"h1", "h2"});
    EXPECT_THAT(exclude_hover(all_hover), IsEmpty());
    EXPECT_EQ(all_hover.size(), 2U);
}

TEST(MeasuredFlights, OfAVtolThatIsNeverOnItsWingOnlyHover) {
    flight::FlightPhases phases;
    phases.sorties = {whole_sortie(10)};
    auto data = select_tracks(series_of_300_s());
    EXPECT_FALSE(extract_flights(data, phases).flights.at(0).only_hovers) << "no VTOL";
    constexpr auto hover = static_cast<double>(flight::VtolState::hover);
    constexpr auto wing = static_cast<double>(flight::VtolState::wing);
    data.vtol_state.time_s = {0.0};
    data.vtol_state.value = {hover};
    EXPECT_TRUE(extract_flights(data, phases).flights.at(0).only_hovers);
    data.vtol_state.time_s = {0.0, 40.0};
    data.vtol_state.value = {hover, wing};
    EXPECT_FALSE(extract_flights(data, phases).flights.at(0).only_hovers);
}

TEST(MeasuredFlights, AreThePowerOfEachPhaseOnItsOwnTime) {
    const auto selection = select({whole_sortie(10)});
    EXPECT_THAT(selection.exclusions, IsEmpty());
    ASSERT_EQ(selection.flights.size(), 1U);
    EXPECT_EQ(selection.flights[0].flight, "flight");
    const auto& takeoff = selection.flights[0].phases[flight::Phase::takeoff].value();
    EXPECT_EQ(takeoff.flight, "flight");
    EXPECT_EQ(takeoff.duration_s, 20.0);
    ASSERT_EQ(takeoff.tau.size(), 21U);  // both ends belong to it
    ASSERT_EQ(takeoff.power_w.size(), 21U);
    for (std::size_t i = 0; i < 21; ++i) {
        EXPECT_DOUBLE_EQ(takeoff.tau[i], static_cast<double>(i) / 20.0);
        EXPECT_DOUBLE_EQ(takeoff.power_w[i], 1010.0 + static_cast<double>(i));
    }
    const auto& cruise = selection.flights[0].phases[flight::Phase::cruise].value();
    EXPECT_EQ(cruise.duration_s, 60.0);
    EXPECT_EQ(cruise.power_w.front(), 1030.0);
    EXPECT_EQ(cruise.power_w.back(), 1090.0);
    EXPECT_EQ(selection.flights[0].phases[flight::Phase::landing].value().power_w.front(), 1090.0);
}

TEST(MeasuredFlights, HaveTheHeightOfTheirTakeOffAndLanding) {
    auto sortie = whole_sortie(10);
    sortie.height_m = 100.0;
    for (std::size_t i = 0; i < 2; ++i) {
        sortie.phases[i].end.altitude_m = 590.0;  // the ends of a take-off and the start of a landing are below
        sortie.phases[i + 1].start.altitude_m = 590.0;
    }
    sortie.phases.front().start.altitude_m = 500.0;
    sortie.phases.back().end.altitude_m = 540.0;  // on a hill
    const auto flight = select({sortie}).flights.at(0);
    EXPECT_EQ(flight.phases[flight::Phase::takeoff]->height_m, std::optional(100.0));
    EXPECT_FALSE(flight.phases[flight::Phase::cruise]->height_m);
    EXPECT_NEAR(flight.phases[flight::Phase::landing]->height_m.value(), 50.0 / 0.9, 1e-9);
    sortie.phases.back().start.altitude_m = 541.0;
    EXPECT_FALSE(select({sortie}).flights.at(0).phases[flight::Phase::landing]->height_m) << "no landing";
}

TEST(MeasuredFlights, LieWithinEdgesBetweenTwoOfThem) {
    flight::Sortie sortie;
    sortie.phases = {span(flight::Phase::takeoff, 10.25, 30.75)};
    const auto selection = select({sortie});
    const auto& takeoff = selection.flights.at(0).phases[flight::Phase::takeoff].value();
    ASSERT_EQ(takeoff.tau.size(), 20U);
    EXPECT_DOUBLE_EQ(takeoff.tau.front(), 0.75 / 20.5);
    EXPECT_DOUBLE_EQ(takeoff.tau.back(), 19.75 / 20.5);
    EXPECT_THAT(takeoff.tau, Each(testing::AllOf(testing::Ge(0.0), testing::Le(1.0))));
    EXPECT_FALSE(selection.flights[0].phases[flight::Phase::cruise].has_value());
}

TEST(MeasuredFlights, EndWithASampleAtTheirVeryEnd) {
    test::SampleColumns columns;
    for (int i = 0; i < 30; ++i) {
        columns.time_s.push_back(64.86 + i);
        columns.power_w.push_back(20.0);
    }
    columns.time_s.push_back(92.7);  // 92.7 - 64.86 is more than 27.84
    columns.power_w.push_back(20.0);
    std::ranges::sort(columns.time_s);
    flight::FlightPhases phases;
    phases.sorties.emplace_back().phases = {span(flight::Phase::takeoff, 64.86, 92.7)};
    const auto flights = extract_flights(select_tracks(test::series_of(columns)), phases).flights;
    EXPECT_EQ(flights.at(0).samples.phases[flight::Phase::takeoff].value().tau.back(), 1.0);
}

TEST(MeasuredFlights, CountEverySortieAsAFlight) {
    const auto selection = select({whole_sortie(0), whole_sortie(150)});
    ASSERT_EQ(selection.flights.size(), 2U);
    EXPECT_EQ(selection.flights[0].flight, "flight");
    EXPECT_EQ(selection.flights[1].flight, "flight#2");
    EXPECT_EQ(selection.flights[1].phases[flight::Phase::cruise]->flight, "flight#2");
    EXPECT_EQ(selection.flights[1].phases[flight::Phase::takeoff]->power_w.front(), 1150.0);
}

TEST(MeasuredFlights, ExcludeWhatTheLogCuts) {
    auto sortie = whole_sortie(10);
    sortie.phases[2].complete = false;
    const auto selection = select({sortie});
    ASSERT_EQ(selection.exclusions.size(), 1U);
    EXPECT_EQ(selection.exclusions[0].flight, "flight");
    EXPECT_EQ(selection.exclusions[0].phase, flight::Phase::landing);
    EXPECT_EQ(selection.exclusions[0].reason, "the log begins or ends within it");
    ASSERT_EQ(selection.flights.size(), 1U);
    EXPECT_TRUE(selection.flights[0].phases[flight::Phase::cruise].has_value());
    EXPECT_FALSE(selection.flights[0].phases[flight::Phase::landing].has_value());
}

TEST(MeasuredFlights, ExcludeWhatBeginsOrEndsInALongGap) {
    auto sortie = whole_sortie(10);
    sortie.phases[0].start.gap_s = 5.0;   // a quarter of its 20 s: just short enough
    sortie.phases[1].end.gap_s = 15.01;   // of 60 s
    sortie.phases[2].start.gap_s = 12.0;  // of 20 s
    sortie.phases[2].end.gap_s = 6.0;
    const auto selection = select({sortie});
    std::vector<std::string> reasons;
    for (const auto& exclusion : selection.exclusions) reasons.push_back(exclusion.reason);
    EXPECT_THAT(reasons, ElementsAre("its end is in a gap of 15.0 s", "its start is in a gap of 12.0 s"));
    ASSERT_EQ(selection.flights.size(), 1U);
    EXPECT_TRUE(selection.flights[0].phases[flight::Phase::takeoff].has_value());
}

TEST(MeasuredFlights, ExcludeWhatHasNoSample) {
    flight::Sortie sortie;
    sortie.phases = {span(flight::Phase::takeoff, 10, 17), span(flight::Phase::cruise, 17, 23),
                     span(flight::Phase::landing, 23.3, 23.6)};
    const auto selection = select({sortie});
    EXPECT_EQ(selection.flights.at(0).phases[flight::Phase::takeoff]->tau.size(), 8U);
    EXPECT_EQ(selection.flights.at(0).phases[flight::Phase::cruise]->tau.size(), 7U) << "enough for a mean power";
    ASSERT_EQ(selection.exclusions.size(), 1U);
    EXPECT_EQ(selection.exclusions[0].phase, flight::Phase::landing);
    EXPECT_EQ(selection.exclusions[0].reason, "it has no sample of the power");
}

TEST(MeasuredFlights, ExcludeACruiseOfTwoSamples) {
    flight::Sortie sortie;
    sortie.phases = {span(flight::Phase::takeoff, 10, 17), span(flight::Phase::cruise, 17, 18.5)};
    const auto selection = select({sortie});
    ASSERT_EQ(selection.exclusions.size(), 1U);
    EXPECT_EQ(selection.exclusions[0].reason, "it lasts 1.5 s, with 2 samples of the power");
}

TEST(MeasuredFlights, AreNoneWhereNothingIsLeft) {
    auto first = whole_sortie(10);
    for (auto& phase : first.phases) phase.complete = false;
    const auto selection = select({first, whole_sortie(150)});
    EXPECT_EQ(selection.exclusions.size(), 3U);
    ASSERT_EQ(selection.flights.size(), 1U);
    EXPECT_EQ(selection.flights[0].flight, "flight#2");  // the name shows the sortie, not the order
    EXPECT_THAT(select({}).flights, IsEmpty());
}

}  // namespace
}  // namespace flightwatt::mechanical

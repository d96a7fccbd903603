#include "mechanical/flight_bins.h"

#include "helpers/selected_tracks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using Curve = std::function<double(double)>;

flight::Track track(const std::string& name, double step_s, const Curve& curve) {
    flight::Track made{.name = name, .source = "column"};
    for (double t = 0.0; t <= 600.0; t += step_s) {
        made.time_s.push_back(t);
        made.value.push_back(curve(t));
    }
    return made;
}

/// Ten minutes at a gently varying airspeed, with a climb of 1 m/s from 300 to 330 s.
flight::FlightSeries some_series() {
    flight::FlightSeries series;
    series.flight = "test";
    series.tracks = {
        track("altitude_m", 0.5, [](double t) { return 100.0 + std::clamp(t - 300.0, 0.0, 30.0); }),
        track("power_w", 1.0, [](double t) { return 20.0 + 0.01 * t; }),
        track("airspeed_m_per_s", 1.0, [](double t) { return t < 480.0 ? 12.0 + 0.001 * t : 14.0 + 0.001 * t; }),
        track("roll_deg", 0.2, [](double t) { return t < 60.0 ? 30.0 : 0.0; }),
    };
    return series;
}

BinnedFlight motion(const flight::FlightSeries& series, double start_s = 0.0, double end_s = 600.0) {
    return bin_flight(select_tracks(series), {{flight::Phase::cruise, start_s, end_s}});
}

TEST(FlightBins, AverageThePowerAndTheTerms) {
    const auto found = motion(some_series());
    ASSERT_EQ(found.bins.size(), 20u);
    EXPECT_EQ(found.no_bins_reason, "");
    EXPECT_TRUE(found.bank_measured);
    const auto& bin = found.bins[1];
    EXPECT_DOUBLE_EQ(bin.start_s, 30.0);
    EXPECT_NEAR(bin.power_w, 20.45, 1e-9);
    EXPECT_EQ(bin.samples, 31u);
    EXPECT_NEAR(bin.airspeed_m_per_s, 12.045, 1e-9);
    EXPECT_NEAR(bin.values[PowerTerm::drag], std::pow(12.045, 3), 0.01);
    EXPECT_NEAR(bin.values[PowerTerm::induced], 1.0 / 12.045, 1e-6);
    EXPECT_NEAR(bin.values[PowerTerm::turn], 1.0 / 3.0 / 12.045, 1e-6);  // tan^2 of 30 degrees
    EXPECT_NEAR(found.bins[5].values[PowerTerm::turn], 0.0, 1e-12);
    EXPECT_EQ(bin.values[PowerTerm::constant], 1.0);
}

TEST(FlightBins, CountSpeedAsHeight) {
    const auto found = motion(some_series());
    // 1 m/s up, and the airspeed from 12.3 to 12.33 m/s
    EXPECT_NEAR(found.bins[10].values[PowerTerm::climb], 1.0 + (12.33 * 12.33 - 12.3 * 12.3) / 2.0 / 9.80665 / 30.0,
                1e-3);
    EXPECT_EQ(found.bins[10].values[PowerTerm::descent], 0.0);
    // Slowing down at a constant height is a descent in energy.
    auto slowing = some_series();
    slowing.tracks[2] = track("airspeed_m_per_s", 1.0, [](double t) { return 16.0 - 0.01 * t; });
    const auto slowed = motion(slowing);
    const auto& bin = slowed.bins[1];
    EXPECT_LT(bin.values[PowerTerm::descent], -0.01);
    EXPECT_EQ(bin.values[PowerTerm::descent], bin.values[PowerTerm::climb]);
}

TEST(FlightBins, FillTheirSpansEvenly) {
    const auto found = motion(some_series(), 10.0, 110.0);
    ASSERT_EQ(found.bins.size(), 3u);
    EXPECT_DOUBLE_EQ(found.bins.front().start_s, 10.0);
    EXPECT_NEAR(found.bins.back().start_s + found.bins.back().duration_s, 110.0, 1e-9);
    EXPECT_EQ(motion(some_series(), 100.0, 108.0).bins.size(), 1u);
    EXPECT_TRUE(motion(some_series(), 100.0, 100.0).bins.empty());
}

TEST(FlightBins, AreThereOnlyWhereAllWasMeasured) {
    for (const auto* name : {"power_w", "airspeed_m_per_s", "altitude_m"}) {
        auto series = some_series();
        for (auto& gappy : series.tracks) {
            if (gappy.name != name) continue;
            flight::Track kept = gappy;
            kept.time_s.clear();
            kept.value.clear();
            for (std::size_t i = 0; i < gappy.time_s.size(); ++i) {
                if (gappy.time_s[i] > 65.0 && gappy.time_s[i] < 85.0) continue;  // 10 s of bin 2 are far from a sample
                if (gappy.time_s[i] > 120.0 && gappy.time_s[i] < 180.0) continue;
                kept.time_s.push_back(gappy.time_s[i]);
                kept.value.push_back(gappy.value[i]);
            }
            gappy = kept;
        }
        const auto found = motion(series);
        EXPECT_EQ(found.bins.size(), 18u) << name;
        for (const auto& bin : found.bins) EXPECT_TRUE(bin.start_s < 115.0 || bin.start_s > 175.0) << name;
    }
}

/// Rotors carry without airspeed, which ground speed replaces; payload, mass and rotors are constants of the log.
TEST(FlightBins, OfARotorcraftHaveItsTerms) {
    auto series = some_series();
    series.firmware = "rotorcraft";
    series.tracks[2].name = "ground_speed_m_per_s";
    for (const auto& [name, value] : {std::pair{"payload_kg", 0.5}, {"mass_kg", 3.0}, {"rotor_area_m2", 0.4}})
        series.tracks.push_back(track(name, 1.0, [constant = value](double) { return constant; }));
    const auto found = motion(series);
    EXPECT_TRUE(found.is_rotorcraft);
    EXPECT_TRUE(found.payload_known);
    ASSERT_FALSE(found.bins.empty()) << found.no_bins_reason;
    const auto& bin = found.bins.front();
    EXPECT_DOUBLE_EQ(bin.values[PowerTerm::payload], 0.5);
    EXPECT_DOUBLE_EQ(bin.values[PowerTerm::induced], 0.0);
    EXPECT_GT(bin.values[PowerTerm::blade], 0.0);
    EXPECT_NEAR(bin.values[PowerTerm::hover], induced_power_w({0.5, RotorLoading{3.0, 0.4}}, bin.airspeed_m_per_s),
                5.0);
}

TEST(FlightBins, HaveTheSlopesOfTheirTermsByTheAirspeed) {
    FlightBin bin{.values = term_values({12.0, 1.0, 1.2}), .airspeed_m_per_s = 12.0};
    const auto slopes = airspeed_slopes(bin);
    constexpr double step = 1e-4;
    const auto faster = term_values({12.0 + step, 1.0, 1.2});
    for (const auto term : all_power_terms)
        EXPECT_NEAR(slopes[term], (faster[term] - bin.values[term]) / step, 0.01) << to_string(term);
}

TEST(FlightBins, StateTheErrorOfAnEstimatedAirspeed) {
    auto series = some_series();
    EXPECT_EQ(motion(series).airspeed_sd_m_per_s, 0.0);
    series.firmware = "fixedwing";
    series.tracks[2] = track("ground_speed_m_per_s", 1.0, [](double) { return 12.0; });
    series.tracks.push_back(track("course_deg", 1.0, [](double t) { return std::fmod(9.0 * t, 360.0); }));
    const auto found = motion(series);
    ASSERT_EQ(found.bins.size(), 20u);
    EXPECT_NEAR(found.bins[3].airspeed_m_per_s, 12.0, 0.01);
    EXPECT_GT(found.airspeed_sd_m_per_s, 0.0);
    EXPECT_LE(found.mean_airspeed_sd_m_per_s, found.airspeed_sd_m_per_s);
    series.tracks.back() = track("course_deg", 1.0, [](double t) { return t < 300.0 ? 40.0 : 220.0; });
    EXPECT_THAT(motion(series).no_bins_reason, testing::HasSubstr("and cannot be estimated (no heading within"));
}

TEST(FlightBins, SayWhyThereAreNone) {
    auto glider = some_series();
    glider.tracks.erase(glider.tracks.begin() + 2);
    EXPECT_THAT(motion(glider).no_bins_reason, testing::HasSubstr("airspeed was not measured"));
    auto stuck = some_series();
    stuck.tracks[2] = track("airspeed_m_per_s", 1.0, [](double) { return 0.0; });
    EXPECT_THAT(motion(stuck).no_bins_reason, testing::HasSubstr("airspeed was not measured"));
    auto driving = some_series();
    driving.firmware = "rover";
    EXPECT_THAT(motion(driving).no_bins_reason, testing::HasSubstr("a rover"));
    auto blind = some_series();
    blind.firmware = "rotorcraft";
    blind.tracks.erase(blind.tracks.begin() + 2);
    EXPECT_THAT(motion(blind).no_bins_reason, testing::HasSubstr("neither airspeed nor ground speed"));
    auto apart = some_series();
    apart.tracks[2].time_s.resize(50);
    apart.tracks[2].value.resize(50);
    EXPECT_THAT(motion(apart, 300.0, 600.0).no_bins_reason, testing::HasSubstr("never measured at the same time"));
    auto level = some_series();
    level.tracks.pop_back();
    EXPECT_FALSE(motion(level).bank_measured);
    EXPECT_EQ(motion(level).bins.size(), 20u);
}

TEST(FlightBins, NeedNothingThatComesLater) {
    const auto whole = motion(some_series(), 0.0, 300.0);
    const auto series = some_series();
    const auto cut = motion(truncate_series(series, 300.0), 0.0, 300.0);
    ASSERT_EQ(whole.bins.size(), cut.bins.size());
    for (std::size_t i = 0; i + 1 < cut.bins.size(); ++i)  // the last edge's airspeed is averaged over what is there
        EXPECT_EQ(whole.bins[i].values.values, cut.bins[i].values.values);
}

TEST(FlightBins, WeighAsLongAsTheyAre) {
    std::vector<FlightBin> bins(2);
    bins[0].duration_s = 10.0;
    bins[0].values[PowerTerm::drag] = 1000.0;
    bins[1].duration_s = 30.0;
    bins[1].values[PowerTerm::drag] = 2000.0;
    EXPECT_DOUBLE_EQ(mean_values(bins)[PowerTerm::drag], 1750.0);
    EXPECT_EQ(mean_values({})[PowerTerm::constant], 0.0);
}

}  // namespace
}  // namespace flightwatt::mechanical

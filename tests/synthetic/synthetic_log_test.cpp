#include "synthetic/synthetic_log.h"

#include "flight/segment.h"
#include "flight/telemetry_series.h"
#include "helpers/selected_tracks.h"
#include "telemetry/log_reader.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace flightwatt::synthetic {
namespace {

SyntheticFlight flight_at(double power_w) {
    SyntheticFlight flight;
    flight.power_w = [power_w](flight::Phase, double) { return power_w; };
    return flight;
}

flight::FlightSeries read_back(const SyntheticLog& log) {
    const auto configuration = telemetry::parse_log_configuration(log.log, "x.log");
    return flight::flight_series(
        telemetry::parse_telemetry(log.data, "x.data", configuration, flight::flight_messages()), "7");
}

TEST(SyntheticLog, IsReadAndSegmentedAsItWasFlown) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const auto flight = flight_at(27.0);
        const auto series = read_back(make_synthetic_log(make_scenario(flight), {}, "x", "Made by a test.", seed));
        EXPECT_TRUE(warnings_of(series).empty());
        const auto phases = segment(select_tracks(series));
        ASSERT_EQ(phases.sorties.size(), 1u) << "seed " << seed;
        ASSERT_EQ(phases.sorties[0].phases.size(), 3u);
        for (const auto& span : phases.sorties[0].phases) {
            EXPECT_NEAR(span.start.time_s, flight.start_s(span.phase), 3.0) << "seed " << seed;
            EXPECT_NEAR(span.end.time_s, flight.end_s(span.phase), 3.0) << "seed " << seed;
        }
        EXPECT_EQ(phases.ground_events.size(), 1u) << "the run-up";
    }
}

/// The phases that a scenario's log shows, cut where it begins and ends.
std::vector<std::vector<std::pair<double, double>>> truth_of(const SyntheticScenario& scenario) {
    std::vector<std::vector<std::pair<double, double>>> sorties;
    for (const auto& flight : scenario.flights) {
        auto& phases = sorties.emplace_back();
        for (const auto phase : flight::all_phases) {
            const double start_s = std::max(flight.start_s(phase), scenario.begin_s);
            const double end_s = std::min(flight.end_s(phase), scenario.end_s);
            if (end_s > start_s) phases.emplace_back(start_s, end_s);
        }
    }
    return sorties;
}

TEST(SyntheticLog, HazardsDoNotFoolTheSegmentation) {
    for (const auto& name : anomaly_names()) {
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
            SCOPED_TRACE(name + ", seed " + std::to_string(seed));
            const auto scenario = make_scenario(flight_at(27.0), name);
            const auto series = read_back(make_synthetic_log(scenario, {}, "x", "", seed));
            const auto phases = segment(select_tracks(series));
            const auto truth = truth_of(scenario);
            ASSERT_EQ(phases.sorties.size(), truth.size());
            for (std::size_t s = 0; s < truth.size(); ++s) {
                const auto& spans = phases.sorties[s].phases;
                ASSERT_EQ(spans.size(), truth[s].size());
                for (std::size_t p = 0; p < spans.size(); ++p) {
                    EXPECT_NEAR(spans[p].start.time_s, truth[s][p].first, 3.0) << to_string(spans[p].phase);
                    EXPECT_NEAR(spans[p].end.time_s, truth[s][p].second, 3.0) << to_string(spans[p].phase);
                    const bool cut = truth[s][p].first == scenario.begin_s || truth[s][p].second == scenario.end_s;
                    EXPECT_EQ(spans[p].complete, !cut) << to_string(spans[p].phase);
                }
            }
        }
    }
}

TEST(SyntheticLog, MeasuresThePowerThatWasFlown) {
    SyntheticSensors sensors;
    sensors.lost_fraction = 0.0;
    sensors.current_noise_a = 0.0;
    const auto flight = flight_at(27.0);
    const auto series = read_back(make_synthetic_log(make_scenario(flight), sensors, "x", "", 1));
    const auto power = power_track(series);
    for (std::size_t i = 0; i < power.time_s.size(); ++i) {
        if (power.time_s[i] < flight.lift_off_s || power.time_s[i] > flight.end_s(flight::Phase::landing)) continue;
        EXPECT_NEAR(power.value[i], 27.0, 0.04);
    }
}

TEST(SyntheticLog, LosesLinesAtTheRateAskedFor) {
    SyntheticSensors whole;
    whole.lost_fraction = 0.0;
    SyntheticSensors lossy;
    lossy.lost_fraction = 0.3;
    const auto all = make_synthetic_log(make_scenario(flight_at(27.0)), whole, "x", "", 1).data.size();
    const auto kept = make_synthetic_log(make_scenario(flight_at(27.0)), lossy, "x", "", 1).data.size();
    EXPECT_NEAR(static_cast<double>(kept) / static_cast<double>(all), 0.7, 0.1);
}

TEST(SyntheticLog, SaysThatItIsSyntheticAndRepeatsItself) {
    const auto log = make_synthetic_log(make_scenario(flight_at(27.0)), {}, "x", "Made by a test.", 5);
    EXPECT_NE(log.data.substr(0, log.data.find('\n')).find("SYNTHETIC"), std::string::npos);
    EXPECT_NE(log.log.find("SYNTHETIC"), std::string::npos);
    EXPECT_EQ(make_synthetic_log(make_scenario(flight_at(27.0)), {}, "x", "Made by a test.", 5).data, log.data);
    EXPECT_NE(make_synthetic_log(make_scenario(flight_at(27.0)), {}, "x", "Made by a test.", 6).data, log.data);
}

}  // namespace
}  // namespace flightwatt::synthetic

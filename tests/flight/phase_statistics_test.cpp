#include "flight/phase_statistics.h"

#include "base/units.h"
#include "flight/load_flight.h"
#include "helpers/sample_columns.h"
#include "helpers/test_paths.h"

#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

FlightSeries ramp() {
    test::SampleColumns series;
    for (int i = 0; i <= 100; ++i) {
        if (i > 40 && i < 50) continue;  // a gap
        series.time_s.push_back(i);
        series.power_w.push_back(2.0 * i);
    }
    return test::series_of(series);
}

TEST(PhaseStatistics, IntegratesLinearlyBetweenSamplesAndEdges) {
    const auto series = ramp();
    // The integral of 2 t from 10.5 to 90.25.
    EXPECT_NEAR(units::joule_from_wh(integrated_energy_wh(select_tracks(series).power_w, 10.5, 90.25)),
                90.25 * 90.25 - 10.5 * 10.5, 1e-9);
    const double whole = integrated_energy_wh(select_tracks(series).power_w, 0, 100);
    EXPECT_NEAR(integrated_energy_wh(select_tracks(series).power_w, 0, 33.3) +
                    integrated_energy_wh(select_tracks(series).power_w, 33.3, 100),
                whole, 1e-12);
    EXPECT_NEAR(units::joule_from_wh(integrated_energy_wh(select_tracks(series).power_w, 20.25, 20.5)),
                0.25 * 2 * 20.375, 1e-9);
}

TEST(PhaseStatistics, CountsSamplesAndGaps) {
    const auto statistics = PowerStatistics(select_tracks(ramp())).between(30, 60);
    EXPECT_EQ(statistics.samples, 22u);
    EXPECT_EQ(statistics.gaps, 1u);
    EXPECT_EQ(statistics.max_gap_s, 10.0);
    EXPECT_FALSE(statistics.counter_energy_wh.has_value());
    EXPECT_EQ(median_interval_s(power_track(ramp()).time_s), 1.0);
    EXPECT_EQ(PowerStatistics(select_tracks(ramp())).between(43, 45).samples, 0u);
}

TEST(PhaseStatistics, AgreesWithTheOnBoardCounterOfTheRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    struct Flight {
        const char* name;
        double cruise_power_w;
    };
    for (const auto& [name, cruise_power_w] :
         {Flight{"20_07_03__12_17_45", 29.9}, Flight{"20_07_05__10_26_44", 18.9}, Flight{"20_07_10__06_53_03", 22.0}}) {
        SCOPED_TRACE(name);
        const auto series = read_flight(test::shared_dir() / "flights" / (std::string(name) + ".data"));
        const auto phases = segment(select_tracks(series)).sorties.at(0).phases;
        const auto cruise =
            PowerStatistics(select_tracks(series)).between(phases[1].start.time_s, phases[1].end.time_s);
        EXPECT_NEAR(cruise.mean_power_w, cruise_power_w, 0.3);
        const auto flight =
            PowerStatistics(select_tracks(series)).between(phases[0].start.time_s, phases[2].end.time_s);
        ASSERT_TRUE(flight.counter_energy_wh.has_value());
        EXPECT_NEAR(flight.energy_wh / *flight.counter_energy_wh, 1.0, 0.005);
    }
}

TEST(PhaseStatistics, CountsGapsInTimeHoweverSeldomThereAreSamples) {
    EXPECT_EQ(gap_threshold_s({0.0, 1.0, 2.0}), 3.0);
    EXPECT_EQ(gap_threshold_s({0.0, 20.0, 40.0}), 10.0);
}

}  // namespace
}  // namespace flightwatt::flight

#include "mission/sampled_flights.h"

#include "helpers/drawn_mission.h"
#include "helpers/paper_missions.h"
#include "helpers/rejected.h"
#include "helpers/steady_mission.h"
#include "mission/mission_file.h"
#include "mission/plan.h"
#include "mission/sampling/flight_draws.h"

#include <cmath>

#include <boost/math/distributions/normal.hpp>
#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::paper_mission;

/// 20 W +- 5 % over 1000 s from 36 kJ, so that 55.6 +- 2.78 points are lost.
Mission gaussian_depletion(double reserve_soc_percent) {
    auto mission = test::steady_mission();
    mission.setup.reserve_soc_percent = reserve_soc_percent;
    mission.setup.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    return mission;
}

MonteCarloResult sampled(const MissionVariant& mission, std::size_t samples, std::uint64_t seed,
                         const std::vector<Disturbance>& disturbances = {}, std::size_t band_times = 0) {
    return sample_flights(prepare_mission(mission), disturbances, {samples, seed, band_times});
}

TEST(SampledFlights, AgreeWithTheClosedFormOfAGaussianDepletion) {
    const boost::math::normal_distribution<double> final_soc(100.0 - 20.0 / 0.36, 1.0 / 0.36);
    for (const double reserve : {38.0, 41.0, 44.0, 47.0}) {
        for (const std::uint64_t seed : {1, 2, 3}) {
            const double exact = boost::math::cdf(final_soc, reserve);
            const auto flights = sampled(gaussian_depletion(reserve), 20000, seed);
            const double standard_error = std::sqrt(exact * (1.0 - exact) / 20000.0);
            EXPECT_NEAR(flights.probability_below_reserve, exact, 4.0 * standard_error) << reserve;
            EXPECT_NEAR(flights.final_soc_mean_percent, final_soc.mean(), 4.0 * 2.78 / std::sqrt(20000.0));
            EXPECT_NEAR(flights.final_soc_sd_percent, final_soc.standard_deviation(), 0.06);
            EXPECT_NEAR(flights.final_soc_quantiles_percent[0], boost::math::quantile(final_soc, 0.05), 0.2);
            EXPECT_LT(flights.probability_below_reserve_95.low, flights.probability_below_reserve);
            EXPECT_GT(flights.probability_below_reserve_95.high, flights.probability_below_reserve);
        }
    }
}

TEST(SampledFlights, CountEmptyBatteriesAsBelowAnyReserve) {
    auto mission = gaussian_depletion(0.0);
    mission.setup.initial_soc_percent = 20.0 / 0.36;  // empty in half of the flights
    const auto flights = sampled(mission, 10000, 1);
    EXPECT_NEAR(flights.probability_below_reserve, 0.5, 4.0 * 0.005);
    EXPECT_EQ(flights.probability_depleted, flights.probability_below_reserve);
    EXPECT_EQ(flights.final_soc_quantiles_percent[0], 0.0);
}

TEST(SampledFlights, AreTheSameForASeed) {
    auto mission = paper_mission("phased");
    mission.setup.uncertainty.level_sd_percent[flight::Phase::cruise] = 3.0;
    mission.setup.uncertainty.duration_sd_s[flight::Phase::cruise] = 10.0;
    const auto first = sampled(mission, 500, 7);
    const auto again = sampled(mission, 500, 7);
    EXPECT_EQ(first.final_soc_mean_percent, again.final_soc_mean_percent);
    EXPECT_EQ(first.final_soc_quantiles_percent, again.final_soc_quantiles_percent);
    EXPECT_NE(first.final_soc_mean_percent, sampled(mission, 500, 8).final_soc_mean_percent);
    // A flight depends on its number alone, not on how many there are or who flies it.
    const auto spreads = collect_uncertainty(mission.setup);
    EXPECT_EQ(apply_draw(mission.setup, spreads, draw_normals(count_normals(mission.setup), 7, 3)).duration_s.values,
              apply_draw(mission.setup, spreads, draw_normals(count_normals(mission.setup), 7, 3)).duration_s.values);
    EXPECT_NE(apply_draw(mission.setup, spreads, draw_normals(count_normals(mission.setup), 7, 3)).duration_s.values,
              apply_draw(mission.setup, spreads, draw_normals(count_normals(mission.setup), 7, 4)).duration_s.values);
}

TEST(SampledFlights, DepleteInProportionToDurations) {
    auto mission = gaussian_depletion(10.0);
    mission.setup.uncertainty.level_sd_percent[flight::Phase::cruise].reset();
    mission.setup.uncertainty.duration_sd_s[flight::Phase::cruise] = 50.0;
    const auto flights = sampled(mission, 20000, 1);
    EXPECT_NEAR(flights.final_soc_sd_percent, 0.05 * 20.0 / 0.36, 0.06);
}

TEST(SampledFlights, GiveBandsOverTime) {
    const auto bands = sampled(gaussian_depletion(10.0), 5000, 1, {}, 11).bands;
    ASSERT_EQ(bands.size(), 11U);
    EXPECT_EQ(bands.front().p05_percent, 100.0);
    EXPECT_EQ(bands[5].time_s, 500.0);
    EXPECT_NEAR(bands[5].p50_percent, 100.0 - 10.0 / 0.36, 0.15);
    EXPECT_NEAR(bands[5].p95_percent - bands[5].p05_percent, 2.0 * 1.645 * 0.5 / 0.36, 0.2);
    EXPECT_NEAR(bands.back().p50_percent, 100.0 - 20.0 / 0.36, 0.15);
}

TEST(SampledFlights, AreTheSameWithBandsOnATheveninPack) {
    const auto mission = mission::read_mission(test::source_dir() / "missions/synthetic/thevenin-pack.toml");
    const auto alone = sample_flights(prepare_mission(mission), {}, {50, 1, 0});
    const auto banded = sample_flights(prepare_mission(mission), {}, {50, 1, 12});
    EXPECT_EQ(banded.probability_below_reserve, alone.probability_below_reserve);
    EXPECT_NEAR(banded.final_soc_mean_percent, alone.final_soc_mean_percent, 1e-3) << "the steps end elsewhere";
    ASSERT_EQ(banded.bands.size(), 12U);
    double last_percent = 100.0;
    for (const auto& band : banded.bands) {
        EXPECT_LE(band.p05_percent, band.p50_percent);
        EXPECT_LE(band.p50_percent, last_percent);
        last_percent = band.p50_percent;
    }
    EXPECT_NEAR(last_percent, banded.final_soc_mean_percent, 1.0);
}

TEST(SampledFlights, LetAnAdaptivePolicyAnswerEachFlight) {
    auto adaptive = test::paper_problem("adaptive-replanned");
    adaptive.setup.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    auto beforehand = adaptive;
    beforehand.adaptive.reset();
    EXPECT_LT(sampled(adaptive, 100, 1).probability_below_reserve, 0.1);
    EXPECT_GT(sampled(beforehand, 100, 1).probability_below_reserve, 0.3);
}

TEST(SampledFlights, SayWhatIsDrawnAndWhatIsNot) {
    auto mission = paper_mission("phased");
    mission.setup.uncertainty.level_sd_percent = {};
    EXPECT_NE(test::rejected([&] { require_uncertainty(mission.setup); }).find("there is nothing to draw flights from"),
              std::string::npos);
    EXPECT_FALSE(has_uncertainty(mission.setup));
    mission.setup.uncertainty.compute_sd_percent[0] = 2.0;
    EXPECT_TRUE(has_uncertainty(mission.setup));
    mission.setup.uncertainty.capacity_sd_percent = 0.0;
    const auto spreads = collect_uncertainty(mission.setup);
    EXPECT_EQ(spreads.sources.varied, std::vector<std::string>{"power of detection (sd 2 %, stated)"});
    EXPECT_EQ(spreads.sources.fixed.size(), 10U);
}

}  // namespace
}  // namespace flightwatt::mission

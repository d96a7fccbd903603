#include "mission/cruise_path.h"

#include "helpers/path_missions.h"
#include "mission/feasibility_limits.h"
#include "mission/planning/limit_search.h"
#include "mission/sampled_flights.h"
#include "mission/simulation.h"
#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::path_element;
using test::path_mission;

const FlightPath up_and_on{{path_element(Leg{1300.0, 0.0}), path_element(Hold{50.0}, 13.0, 50.0),
                            path_element(Leg{1400.0, 90.0}, 14.0), path_element(Leg{700.0, 0.0}, 14.0)}};

TEST(CruisePath, ShowsTheWayOfLegsWhoseTimeWasMeasured) {
    const auto mission = path_mission(
        {{path_element(Hold{50.0, Leg{700.0, 45.0}}), path_element(Hold{20.0}), path_element(Leg{260.0, 0.0})}});
    const auto rows = path_element_results(*mission.cruise_path->plan);
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[0].kind, "leg");
    EXPECT_EQ(rows[0].length_m, std::optional(700.0));
    EXPECT_EQ(rows[0].course_deg, std::optional(45.0));
    EXPECT_EQ(rows[0].duration_s, 50.0);
    EXPECT_EQ(rows[1].kind, "hold");
    EXPECT_FALSE(rows[1].length_m);
    EXPECT_EQ(rows[2].duration_s, 20.0);
}

TEST(CruisePath, IsPiecesOfConstantPower) {
    const auto mission = path_mission(up_and_on);
    const auto& pieces = *mission.cruise_path->pieces;
    ASSERT_EQ(pieces.size(), 3U);  // the last two legs are one
    EXPECT_NEAR(pieces[0].power_w, 0.01 * 13.0 * 13.0 * 13.0, 1e-12);
    EXPECT_NEAR(pieces[1].power_w, 21.97 + 8.0, 1e-9);
    EXPECT_NEAR(pieces[2].power_w, 0.01 * 14.0 * 14.0 * 14.0, 1e-12);
    EXPECT_NEAR(pieces[2].start_s, 150.0, 1e-9);
    EXPECT_NEAR(duration_s(*mission.cruise_path), 300.0, 1e-9);
    const double sum_j = 100.0 * 21.97 + 50.0 * 29.97 + 150.0 * 27.44;
    EXPECT_NEAR(energy_j(*mission.cruise_path), sum_j, 1e-6);
    EXPECT_NEAR(energy_until_j(pieces, 120.0), 2197.0 + 20.0 * 29.97, 1e-6);
    EXPECT_EQ(segment_at(pieces, pieces[1].start_s).power_w, pieces[1].power_w);
    EXPECT_EQ(&segment_at(pieces, -1.0), &pieces.front());
    EXPECT_EQ(&segment_at(pieces, 1e9), &pieces.back());
}

TEST(CruisePath, HasTheMeanOfItsTerms) {
    const auto flown = compute_trajectory(up_and_on, {3.0, 45.0});
    const auto model = test::made_up_wing();
    const auto plan = std::make_shared<const PlannedPath>(PlannedPath{up_and_on, {3.0, 45.0}, model});
    EXPECT_NEAR(sum_of_terms_w(model, mean_terms(model, flown)),
                mean_power_w(compute_cruise(plan, plan->wind, InfeasibleLegPolicy::refuse)), 1e-9);
}

TEST(CruisePath, FollowsALawOfAirspeedAsTheLawDoes) {
    const mechanical::CovariateRegression law{
        mechanical::Covariate::airspeed_cubed, 4, 2200.0, 200.0, 1900.0, 2500.0, 24.0, 24.0 * 200.0 / 2200.0, 1.2};
    const auto model = physical_model_from_drag(law);
    const double cubed = 13.2 * 13.2 * 13.2;
    const auto level = predict_mean_power(law, cubed);
    EXPECT_NEAR(power_w(model, {13.2}), level.power_w, 1e-12);
    const auto constant = constant_power(level);
    const auto uncertainty = prediction_uncertainty(model, mechanical::term_values({13.2}), 600.0);
    EXPECT_NEAR(uncertainty->sd_w, constant.sd_w.value(), 1e-12);
    EXPECT_NEAR(uncertainty->degrees_of_freedom, constant.degrees_of_freedom, 1e-9);
}

TEST(CruisePath, WarnsOfWhatNobodyFlew) {
    const FlightPath path{
        {path_element(Leg{100.0, 0.0}), path_element(Leg{100.0, 0.0}, 18.0), path_element(Circles{9.0, 1.0})}};
    const PlannedPath plan{path, {}, test::made_up_wing()};
    const auto warnings = path_warnings(plan, compute_trajectory(path, {}));
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_EQ(
        warnings[0],
        "leg: 18 m/s with a climb of 0 m/s is beyond what the model's flights flew (11 to 16 m/s, climb -2 to 2 m/s): "
        "its power is extrapolated");
    EXPECT_EQ(warnings[1], "leg: such a circle takes a bank of 62 degrees");
}

TEST(CruisePath, IsFlownBySimulation) {
    const auto mission = path_mission(up_and_on);
    const auto flown = simulate(mission);
    const double energy_wh = energy_j(*mission.cruise_path) / 3600.0;
    EXPECT_NEAR(flown.summary.mechanical_energy_wh, energy_wh, 1e-9);
    EXPECT_NEAR(*flown.summary.final_soc_percent, 100.0 - energy_wh / 10.0 * 100.0, 1e-9);  // 10 V, 1 Ah
    const auto is_jump = [](const SocRow& a, const SocRow& b) {
        return a.time_s == b.time_s && a.power_w != b.power_w;
    };
    EXPECT_EQ(std::adjacent_find(flown.curve.rows.begin(), flown.curve.rows.end(), is_jump)->time_s, 100.0);
    // Disturbed in the middle of a piece, and across two.
    Disturbance gust;
    gust.start_s = 90.0;
    gust.end_s = 110.0;
    gust.mechanical_w = 3.0;
    EXPECT_NEAR(simulate(mission, {}, {gust}).summary.mechanical_energy_wh, energy_wh + 60.0 / 3600.0, 1e-9);
}

/// Tables of the pieces, Runge-Kutta, and Runge-Kutta in steps of a second agree where all three may be used.
TEST(CruisePath, IsTabledAsItIsSimulated) {
    auto mission = path_mission({{path_element(Leg{1300.0, 0.0}), path_element(Circles{60.0, 3.3}),
                                  path_element(Leg{900.0, 200.0}, 14.5, 70.0)}},
                                {5.0, 30.0});
    mission.battery.resistance_ohm = 0.2;
    mission.reserve_soc_percent = 10.0;
    ASSERT_GT(mission.cruise_path->pieces->size(), 20U);
    const double simulated = *simulate(mission).summary.final_soc_percent;
    EXPECT_NEAR(surplus_percent(mission), simulated - 10.0, 1e-7);
    battery::Discharge state{{mission.initial_soc_percent}};
    for (const auto& segment : load_segments(mission, mission.schedule))
        state = advance_segment(mission.battery, 0.0, segment, state);
    EXPECT_NEAR(state.soc_percent, simulated, 1e-7);
    const auto whole = load_segment(make_mission_load(mission), mission.schedule.front());
    EXPECT_NEAR(mechanical_energy_j(whole, whole.end_s), energy_j(*mission.cruise_path), 1e-9);
    EXPECT_EQ(mechanical_w(whole, 10.0), mission.cruise_path->pieces->front().power_w);
    // More than the battery can deliver in one piece alone.
    mission.battery.resistance_ohm = 100.0 / 4.0 / 25.0;
    EXPECT_LT(surplus_percent(mission), 0.0);
}

TEST(CruisePath, DiffersWithTheWind) {
    auto mission =
        path_mission({{path_element(Leg{4000.0, 0.0}), path_element(Leg{4000.0, 180.0})}}, {4.0, 0.0, 1.5, 20.0});
    mission.uncertainty.level_sd_percent = {{0.0, 0.0, 0.0}};
    const auto drawn =
        sample_flights({mission, mission.schedule, std::nullopt, ScheduleOrigin::given}, {}, {4000, 7, 0});
    // By the same numbers, flown one by one.
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    double sum = 0.0;
    double square_sum = 0.0;
    constexpr int flights = 4000;
    for (int i = 0; i < flights; ++i) {
        const Wind wind{std::max(0.0, 4.0 + 1.5 * normal(random)), 20.0 * normal(random)};
        const auto flown = compute_cruise(mission.cruise_path->plan, wind, InfeasibleLegPolicy::refuse);
        const double final_percent = 100.0 - energy_j(flown) / 3600.0 * 10.0;
        sum += final_percent;
        square_sum += final_percent * final_percent;
    }
    const double mean = sum / flights;
    const double sd = std::sqrt(square_sum / flights - mean * mean);
    EXPECT_NEAR(drawn.final_soc_mean_percent, mean, 6.0 * sd / std::sqrt(flights));
    EXPECT_NEAR(drawn.final_soc_sd_percent / sd, 1.0, 0.1);
    const std::vector<std::string> expected{"cruise duration (as the path and the wind make it)",
                                            "wind speed (sd 1.5 m/s, stated)",
                                            "wind direction (sd 20 degrees, stated)"};
    EXPECT_EQ(drawn.sources.varied, expected);
    // Where a drawn wind leaves less than 2 % of the airspeed (0.26 m/s) over ground, the flight fails.
    const auto windy = path_mission({{path_element(Leg{40.0, 0.0})}}, {12.0, 0.0, 2.0, 0.0});
    const auto stormy = sample_flights({windy, windy.schedule, std::nullopt, ScheduleOrigin::given}, {}, {4000, 7, 0});
    EXPECT_NEAR(stormy.probability_below_reserve, 0.5 * std::erfc(0.37 / std::sqrt(2.0)), 0.025);
}

/// The level moves the power of every piece by the same part.
TEST(CruisePath, DiffersWithTheLevel) {
    auto mission = path_mission(up_and_on);
    mission.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    const auto drawn =
        sample_flights({mission, mission.schedule, std::nullopt, ScheduleOrigin::given}, {}, {4000, 3, 0});
    const double used = 100.0 - *simulate(mission).summary.final_soc_percent;
    EXPECT_NEAR(drawn.final_soc_sd_percent, 0.05 * used, 0.004 * used);
}

}  // namespace
}  // namespace flightwatt::mission

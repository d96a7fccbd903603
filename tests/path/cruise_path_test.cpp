#include "path/cruise_path.h"

#include "base/piecewise_linear.h"
#include "helpers/made_up_paths.h"
#include "path/trajectory.h"

#include <optional>

#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

using test::path_element;

const FlightPath up_and_on{{path_element(Leg{1300.0, 0.0}), path_element(Hold{50.0}, 13.0, 50.0),
                            path_element(Leg{1400.0, 90.0}, 14.0), path_element(Leg{700.0, 0.0}, 14.0)}};

TEST(CruisePath, ShowsTheWayOfLegsWhoseTimeWasMeasured) {
    const FlightPath path{
        {path_element(Hold{50.0, Leg{700.0, 45.0}}), path_element(Hold{20.0}), path_element(Leg{260.0, 0.0})}};
    const auto rows = path_element_results({path, {}, test::made_up_wing()});
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
    const auto cruise = test::made_up_cruise(up_and_on);
    const auto& pieces = *cruise.pieces;
    ASSERT_EQ(pieces.time_s.size(), 4U);  // the last two legs are one
    EXPECT_NEAR(pieces.energy_j[1], 100.0 * 0.01 * 13.0 * 13.0 * 13.0, 1e-9);
    EXPECT_NEAR(pieces.energy_j[2] - pieces.energy_j[1], 50.0 * (21.97 + 8.0), 1e-9);
    EXPECT_NEAR(pieces.energy_j[3] - pieces.energy_j[2], 150.0 * 0.01 * 14.0 * 14.0 * 14.0, 1e-9);
    EXPECT_NEAR(pieces.time_s[2], 150.0, 1e-9);
    EXPECT_NEAR(duration_s(cruise), 300.0, 1e-9);
    const double sum_j = 100.0 * 21.97 + 50.0 * 29.97 + 150.0 * 27.44;
    EXPECT_NEAR(energy_j(cruise), sum_j, 1e-6);
    EXPECT_NEAR(interpolate_extended(pieces.time_s, pieces.energy_j, 120.0), 2197.0 + 20.0 * 29.97, 1e-6);
}

TEST(CruisePath, HasTheMeanOfItsTerms) {
    const auto flown = compute_trajectory(up_and_on, {3.0, 45.0});
    const auto model = test::made_up_wing();
    EXPECT_NEAR(sum_of_terms_w(model, mean_terms(model, flown)),
                mean_power_w(test::made_up_cruise(up_and_on, {3.0, 45.0})), 1e-9);
}

/// There and back along a wind w: of k V^3 + d / V the energy is (k V^3 + d / V) 2 V / (V^2 - w^2) per metre.
TEST(CruisePath, KnowsTheSpeedOfLeastEnergyInItsWind) {
    auto model = test::made_up_wing();
    EXPECT_FALSE(best_path_speed({up_and_on, {}, model}).has_value()) << "no induced drag";
    model.terms = {mechanical::PowerTerm::drag, mechanical::PowerTerm::induced};
    model.coefficients[mechanical::PowerTerm::drag] = 0.01;
    model.coefficients[mechanical::PowerTerm::induced] = 300.0;
    model.covariance = {{1e-8, 0.0}, {0.0, 1.0}};
    const FlightPath path{{path_element(Leg{1000.0, 0.0}), path_element(Leg{1000.0, 180.0})}};
    const auto energy_wh = [](double v, double w) {
        return 1000.0 * (0.01 * v * v * v + 300.0 / v) * 2.0 * v / (v * v - w * w) / 3600.0;
    };
    const auto speed = best_path_speed({path, {5.0, 0.0}, model}).value();
    const double best = speed.best.airspeed_m_per_s.value();
    EXPECT_NEAR(speed.best.cost.value(), energy_wh(best, 5.0), 1e-9);
    EXPECT_LT(energy_wh(best, 5.0), energy_wh(best - 0.05, 5.0));
    EXPECT_LT(energy_wh(best, 5.0), energy_wh(best + 0.05, 5.0));
    EXPECT_NEAR(speed.planned_wh, energy_wh(13.0, 5.0), 1e-9);
    EXPECT_GT(best, best_path_speed({path, {}, model})->best.airspeed_m_per_s.value()) << "faster than in calm air";
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
    EXPECT_EQ(warnings[1], "leg: such a turn takes a bank of 62 degrees");
}

}  // namespace
}  // namespace flightwatt::path

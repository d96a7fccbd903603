#include "live/turn_home.h"

#include "helpers/made_up_paths.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using path::FlightPath;
using path::Leg;

FlightPath out_and_on() {
    return {{test::path_element(Leg{1000.0, 0.0}, 10.0), test::path_element(Leg{1000.0, 90.0}, 10.0)}};
}

/// 10 W wherever it flies, on an ideal battery of 1 Wh.
struct Trial {
    path::PlannedPath plan{out_and_on(), {}, test::made_up_wing()};
    ReturnFlightInput budget;

    Trial() {
        plan.power.coefficients = {};
        plan.power.terms = {mechanical::PowerTerm::constant};
        plan.power.coefficients[mechanical::PowerTerm::constant] = 10.0;
        budget.battery.voltage_v = 10.0;
        budget.battery.capacity_ah = 0.1;
        budget.cruise_ahead = {{10.0, 200.0}};
    }
    ReturnDeadline turn(double on_path_s) const { return latest_return(path::PathForecast(plan), on_path_s, budget); }
    void charge_for(double time_s) { budget.now = {time_s * 10.0 / 3600.0 * 100.0, 0.0}; }
};

TEST(TurnHome, TurnsWhereTheWayBackJustKeepsTheReserve) {
    Trial trial;
    trial.charge_for(101.0);
    const auto turn = trial.turn(0.0);
    ASSERT_TRUE(turn.latest_in_s);
    EXPECT_EQ(*turn.latest_in_s, 50.0) << "out and back along the first leg";
    EXPECT_FALSE(turn.path_can_be_flown);
    trial.budget.power_factor = 2.0;
    EXPECT_EQ(trial.turn(0.0).latest_in_s, 30.0) << "a third of 100 s, in steps of 10";
}

TEST(TurnHome, SaysWhereThePathCanBeFlownAndWhereItIsTooLate) {
    Trial trial;
    trial.charge_for(345.0);  // 200 s and the diagonal's 141.4 s
    EXPECT_TRUE(trial.turn(0.0).path_can_be_flown);
    trial.charge_for(335.0);
    const auto nearly = trial.turn(0.0);
    EXPECT_FALSE(nearly.path_can_be_flown);
    EXPECT_EQ(nearly.latest_in_s, 190.0);
    trial.charge_for(80.0);
    trial.budget.cruise_ahead = {{10.0, 100.0}};
    EXPECT_FALSE(trial.turn(100.0).latest_in_s) << "100 s from home";
    trial.charge_for(110.0);
    EXPECT_TRUE(trial.turn(100.0).latest_in_s);
    trial.budget.landing = battery::ConstantLoad{10.0, 20.0};
    EXPECT_FALSE(trial.turn(100.0).latest_in_s) << "the landing counts";
}

TEST(TurnHome, AWindThatForbidsTheWayHomeIsTooLate) {
    Trial trial;
    trial.charge_for(300.0);
    trial.plan.path = {{test::path_element(Leg{1000.0, 180.0}, 10.0)}};
    trial.plan.wind = {20.0, 0.0};
    EXPECT_FALSE(trial.turn(100.0).latest_in_s);
}

TEST(SocAhead, EndsWithThePrediction) {
    PredictionInput basis;
    basis.battery = battery::Battery{};
    basis.battery->voltage_v = 10.0;
    basis.battery->capacity_ah = 1.0;
    Prediction prediction;
    prediction.cruise.remaining_mean_w = 10.0;
    prediction.remaining_s = 1800.0;
    prediction.landing.energy_wh = 0.5;
    prediction.landing_s = 100.0;
    const auto curve = soc_ahead(basis, prediction, {90.0, 0.0}, 50.0);
    EXPECT_NEAR(curve.time_s.back(), 1950.0, 1e-6);
    EXPECT_NEAR(curve.value.back(), 35.0, 1e-6) << "5.5 Wh of 10";
    EXPECT_LT(curve.time_s.size(), 120U);
    EXPECT_LT(soc_ahead(basis, prediction, {20.0, 0.0}, 50.0).time_s.back(), 50.0 + 721.0) << "2 Wh at 10 W";
}

}  // namespace
}  // namespace flightwatt::live

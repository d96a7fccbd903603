#include "live/prediction.h"

#include "base/error.h"
#include "battery/battery_toml.h"
#include "helpers/made_up_paths.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"
#include "mission/mission_file.h"
#include "mission/mission_read_options.h"

#include <cmath>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

Prediction made_up() {
    Prediction prediction;
    prediction.remaining_s = 360.0;
    prediction.cruise.remaining_mean_w = 20.0;
    prediction.cruise.energy.energy_wh = 2.0;
    prediction.landing.energy_wh = 0.5;
    prediction.landing_s = 90.0;
    prediction.remaining_energy.energy_wh = 2.5;
    prediction.interval = {2.0, 3.0};
    return prediction;
}

TEST(Prediction, FliesTheBatteryThroughTheRest) {
    battery::Battery battery;
    battery.capacity_ah = 1.0;
    battery.voltage_v = 10.0;
    BatteryNow now{{90.0, 0.0}, 0.1, {100.0}};
    auto prediction = made_up();
    auto of = forecast_battery(battery, {}, now, prediction);
    EXPECT_NEAR(of.expected.soc_now_percent, 90.0, 1e-9);
    EXPECT_NEAR(of.expected.soc_percent, 65.0, 1e-6) << "2.5 Wh of 10 Wh";
    EXPECT_NEAR(of.worst.soc_percent, 60.0, 1e-6) << "3 Wh at the high end";
    prediction.landing_s = 0.0;  // a mission without one
    of = forecast_battery(battery, {}, now, prediction);
    EXPECT_NEAR(of.expected.soc_percent, 70.0, 1e-6);
    battery.intervals.capacity_ah = Interval{0.5, 2.0};
    now.initial.sd_percent = 10.0;  // by the voltage at rest
    of = forecast_battery(battery, {}, now, prediction);
    EXPECT_NEAR(of.expected.soc_now_percent, 90.0, 1e-9);
    EXPECT_NEAR(of.worst.soc_now_percent, 100.0 - 19.6 - 20.0, 0.01) << "0.1 Ah of 0.5 Ah";
    now.initial.sd_percent = 50.0;
    EXPECT_EQ(forecast_battery(battery, {}, now, prediction).worst.fails_after_s, 0.0) << "it may be empty";
}

TEST(Prediction, ThePowerAheadKeepsItsCourseAlongAPath) {
    auto prediction = made_up();
    prediction.remaining_power = {{30.0, 120.0}, {15.0, 240.0}};  // 2 Wh
    prediction.cruise.energy.energy_wh = 2.2;
    const auto ahead = remaining_power(prediction, 0.5);
    ASSERT_EQ(ahead.size(), 3U);
    EXPECT_NEAR(ahead[0].power_w, 16.5, 1e-9);
    EXPECT_NEAR(ahead[1].power_w, 8.25, 1e-9);
    EXPECT_NEAR(ahead[2].power_w, 10.0, 1e-9) << "0.5 Wh in 90 s, half of it";
}

TEST(Prediction, RefusesAModelThatDoesNotSayHowFlightsDiffer) {
    const mechanical::MechanicalModel model;
    EXPECT_THROW(require_interval(model, flight::Phase::cruise, "model.toml"), InputError);
    EXPECT_THROW(require_physical(model, "model.toml", "--airspeed"), InputError);
}

TEST(Prediction, RefusesTheBatteryOfAnotherAircraft) {
    PredictionInput basis;
    basis.battery = battery::read_battery(test::source_dir() / "fits/battery/synthetic-3s.toml");
    basis.battery_file = "pack.toml";
    const auto refusal_at = [&](double rest_v) {
        battery::DischargeRecord flown;
        flown.resting_voltage_v = rest_v;
        return test::rejected([&] { initial_charge(basis, flown); });
    };
    EXPECT_THAT(refusal_at(24.9), testing::HasSubstr("pack.toml: the pack of the flight has 24.9 V at rest"));
    EXPECT_NE(refusal_at(7.4), "");
    for (const double rest_v : {10.0, 12.4, 12.9}) EXPECT_EQ(refusal_at(rest_v), "") << rest_v;
}

TEST(Prediction, NamesACruiseThatIsNotOfItsModel) {
    PredictionInput basis;
    basis.model = mechanical::read_predicting_model(test::source_dir() / "fits/mechanical/synthetic-wing.toml");
    auto prediction = made_up();
    EXPECT_EQ(model_deviation(prediction, basis).fraction, 0.0) << "no cruise yet";
    prediction.flown.cruise_start_s = 0.0;
    prediction.flown.until_s = 600.0;
    const auto expected =
        predict_before_flight(forecast_of(basis.model, flight::Phase::cruise), prediction.flown.cruise_s()).energy_wh;
    prediction.flown.cruise_energy_wh = expected;
    EXPECT_LT(model_deviation(prediction, basis).fraction, 0.1);
    prediction.flown.cruise_energy_wh = 2.0 * expected;
    EXPECT_GT(model_deviation(prediction, basis).fraction, 1.0);
    EXPECT_THAT(model_deviation(prediction, basis).text, testing::HasSubstr("95 of 100 flights of the model take"));
}

TEST(Prediction, ABatteryOfConstantVoltageNeedsItsStateOfCharge) {
    PredictionInput basis;
    basis.battery = battery::Battery{};
    EXPECT_THROW(initial_charge(basis, {}), InputError);
    basis.initial_soc_percent = 80.0;
    EXPECT_EQ(initial_charge(basis, {}).soc_percent, 80.0);
    EXPECT_EQ(initial_charge(basis, {}).sd_percent, 0.0) << "given";
}

using testing::HasSubstr;

mission::MissionSetup setup_in(const std::string& file) {
    mission::MissionReadOptions reading;
    reading.allow_unplanned = true;
    return setup_of(mission::read_mission(test::source_dir() / file, reading));
}

TEST(PredictionBasis, HoldsWhatAMissionSays) {
    const auto setup = setup_in("missions/synthetic/survey-path.toml");
    const auto basis = input_from_mission(setup, "survey-path.toml");
    EXPECT_EQ(basis.no_prediction_reason, "");
    ASSERT_NE(basis.path, nullptr);
    EXPECT_FALSE(basis.cruise_s);
    EXPECT_EQ(basis.landing_s, setup.duration_s[flight::Phase::landing]);
    EXPECT_EQ(basis.takeoff_s, setup.duration_s[flight::Phase::takeoff]);
    EXPECT_EQ(basis.limits.reserve_soc_percent, setup.reserve_soc_percent);
    ASSERT_TRUE(basis.battery);
    EXPECT_EQ(basis.battery->capacity_ah, setup.battery.capacity_ah);
    EXPECT_FALSE(energy_input_from_mission(setup, "survey-path.toml").battery);
}

/// As in drawn flights: what the mission states is known, unless it states how far it is not.
TEST(PredictionBasis, TheCapacityIsAsUncertainAsTheMissionSays) {
    auto setup = setup_in("missions/synthetic/survey-path.toml");
    const auto interval_of = [&] { return input_from_mission(setup, "m.toml").battery->intervals.capacity_ah; };
    setup.capacity_is_stated = false;
    setup.battery.intervals.capacity_ah = Interval{0.9, 1.2};
    EXPECT_EQ(interval_of()->low, 0.9);
    setup.capacity_is_stated = true;
    EXPECT_FALSE(interval_of());
    setup.uncertainty.capacity_sd_percent = 3.0;
    EXPECT_NEAR(interval_of()->high, setup.battery.capacity_ah * (1.0 + 1.96 * 0.03), 1e-12);
    EXPECT_NEAR(interval_of()->low, setup.battery.capacity_ah * (1.0 - 1.96 * 0.03), 1e-12);
}

TEST(PredictionBasis, SaysWhyAPublishedModelPredictsNothing) {
    const auto setup = setup_in("missions/paper/phased.toml");
    const auto basis = input_from_mission(setup, "phased.toml");
    EXPECT_THAT(basis.no_prediction_reason, HasSubstr("does not show how the power of flights differs"));
    EXPECT_EQ(basis.cruise_s, setup.duration_s[flight::Phase::cruise]);
    EXPECT_THROW(energy_input_from_mission(setup, "phased.toml"), InputError);
}

TEST(PredictionBasis, TakesTheModelsLanding) {
    const std::string file = "fits/mechanical/synthetic-wing.toml";
    auto model = mechanical::read_mechanical_model(test::source_dir() / file);
    const auto basis = input_from_model(model, file, 300.0);
    EXPECT_EQ(basis.remaining_s, 300.0);
    EXPECT_EQ(basis.landing_s, model.phases[flight::Phase::landing].duration_s);
    model.phases[flight::Phase::landing].level_spread.reset();
    EXPECT_THROW(input_from_model(model, file, 300.0), InputError);
}

/// Flights whose landings take 3 s more for each second of their take-offs, give or take half a second.
mechanical::MechanicalModel model_of_high_and_low_flights() {
    auto model = mechanical::read_mechanical_model(test::source_dir() / "fits/mechanical/synthetic-wing.toml");
    model.flights.clear();
    for (const int i : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}) {
        mechanical::FlightContribution flight;
        const double odd_s = i % 2 == 0 ? 0.5 : -0.5;
        flight.phases[flight::Phase::takeoff] = {0.1, 20.0 + i, 0.0, 0, 50.0};
        flight.phases[flight::Phase::cruise] = {0.1, 500.0, 0.0, 0, 25.0};
        flight.phases[flight::Phase::landing] = {0.1, 40.0 + 3.0 * i + odd_s, 0.0, 0, 10.0};
        model.flights.push_back(flight);
    }
    model.phases[flight::Phase::takeoff].duration_s = 24.5;
    model.phases[flight::Phase::landing].duration_s = 53.5;
    return model;
}

mechanical::FlightProgress after(double takeoff_s, double cruise_s) {
    mechanical::FlightProgress flown{0.0, takeoff_s, takeoff_s + cruise_s};
    flown.phases[flight::Phase::takeoff] = {takeoff_s, takeoff_s * 50.0 / 3600.0};
    flown.cruise_energy_wh = cruise_s * 25.0 / 3600.0;
    if (cruise_s > 0.0) flown.phases[flight::Phase::cruise] = {cruise_s, flown.cruise_energy_wh};
    return flown;
}

TEST(Durations, OfALandingFollowThoseOfTheTakeoff) {
    const auto input = input_from_model(model_of_high_and_low_flights(), "model.toml", 300.0);
    Remarks remarks;
    const auto low = predict_energy(input, after(20.0, 100.0), {}, remarks);
    const auto high = predict_energy(input, after(29.0, 100.0), {}, remarks);
    EXPECT_NEAR(high.landing_s - low.landing_s, 27.0 * 9.0 / 12.0, 1.0) << "shrunk: ten flights, and three without";
    EXPECT_LT(low.landing_sd_s, 8.0);
    EXPECT_GT(low.landing_sd_s, 3.0);
    EXPECT_TRUE(remarks.notes.empty());
}

TEST(Durations, OfALandingAreUnknownUnlessTheyAreStated) {
    auto input = input_from_model(model_of_high_and_low_flights(), "model.toml", 300.0);
    Remarks remarks;
    const auto unknown = predict_energy(input, after(25.0, 100.0), {}, remarks);
    EXPECT_GT(unknown.landing_sd_s, 0.0);
    input.duration_sd_s[flight::Phase::landing] = 0.0;
    input.landing_s = unknown.landing_s;
    const auto stated = predict_energy(input, after(25.0, 100.0), {}, remarks);
    EXPECT_EQ(stated.landing_sd_s, 0.0);
    EXPECT_NEAR(unknown.remaining_energy.variance_wh2 - stated.remaining_energy.variance_wh2,
                std::pow(unknown.landing_sd_s * stated.landing.energy_wh / stated.landing_s, 2), 1e-9);
    input.duration_sd_s[flight::Phase::landing] = 300.0;
    const auto wide = predict_energy(input, after(25.0, 100.0), {}, remarks);
    const double landing_w = wide.landing.energy_wh * 3600.0 / wide.landing_s;
    EXPECT_NEAR(std::sqrt(wide.remaining_energy.variance_wh2), 300.0 * landing_w / 3600.0, 0.05);
}

TEST(Durations, OfACruiseAreUnknownWhereTheMissionStatesNone) {
    auto input = input_from_model(model_of_high_and_low_flights(), "model.toml", 300.0);
    Remarks remarks;
    const auto stated = predict_energy(input, after(25.0, 200.0), {}, remarks);
    input.remaining_s.reset();
    input.cruise_s = 500.0;
    input.duration_sd_s[flight::Phase::cruise] = 60.0;
    const auto unknown = predict_energy(input, after(25.0, 200.0), {}, remarks);
    EXPECT_NEAR(unknown.remaining_energy.energy_wh, stated.remaining_energy.energy_wh, 1e-9);
    EXPECT_NEAR(unknown.remaining_energy.variance_wh2 - stated.remaining_energy.variance_wh2,
                std::pow(60.0 * stated.cruise.remaining_mean_w / 3600.0, 2), 1e-9);
}

TEST(Durations, BeginWithTheRestOfATakeoff) {
    const auto input = input_from_model(model_of_high_and_low_flights(), "model.toml", 300.0);
    Remarks remarks;
    const auto climbing = predict_energy(input, after(10.0, 0.0), {}, remarks);
    EXPECT_NEAR(climbing.takeoff_s, 14.5, 1e-9);
    EXPECT_NEAR(climbing.remaining_s, 285.5, 1e-9) << "300 s until the landing begins";
    EXPECT_GT(climbing.takeoff.energy_wh, 0.0);
    EXPECT_NEAR(energy_j(remaining_power(climbing)), climbing.remaining_energy.energy_wh * 3600.0, 1e-6);
    EXPECT_FALSE(remarks.notes.empty());
    EXPECT_EQ(climbing.landing_s, 53.5) << "how high it climbs is not known";
    const auto over = predict_energy(input, after(40.0, 0.0), {}, remarks);
    EXPECT_EQ(over.takeoff_s, 0.0);
    EXPECT_EQ(over.remaining_s, 300.0);
    const auto cruising = predict_energy(input, after(25.0, 100.0), {}, remarks);
    EXPECT_GT(climbing.interval.high - climbing.interval.low, cruising.interval.high - cruising.interval.low);
}

using path::FlightPath;
using path::Leg;

FlightPath out_and_on() {
    return {{test::path_element(Leg{1000.0, 0.0}, 10.0), test::path_element(Leg{1000.0, 90.0}, 10.0)}};
}

/// 10 W wherever it flies, on an ideal battery of 1 Wh.
struct Trial {
    path::PlannedPath plan{out_and_on(), {}, test::made_up_wing()};
    PredictionInput input;
    Prediction prediction;
    battery::BatteryState now;

    Trial() {
        plan.power.coefficients = {};
        plan.power.terms = {mechanical::PowerTerm::constant};
        plan.power.coefficients[mechanical::PowerTerm::constant] = 10.0;
        input.battery.emplace();
        input.battery->voltage_v = 10.0;
        input.battery->capacity_ah = 0.1;
        cruise_for(200.0);
    }
    void cruise_for(double time_s) {
        prediction.remaining_power = {{10.0, time_s}};
        prediction.cruise.energy.energy_wh = 10.0 * time_s / 3600.0;
    }
    ReturnDeadline turn(double on_path_s) {
        input.path = std::make_shared<path::PathForecast>(plan);
        prediction.on_path_s = on_path_s;
        return latest_return(input, prediction, now);
    }
    void charge_for(double time_s) { now = {time_s * 10.0 / 3600.0 * 100.0, 0.0}; }
};

TEST(TurnHome, TurnsWhereTheWayBackJustKeepsTheReserve) {
    Trial trial;
    trial.charge_for(101.0);
    const auto turn = trial.turn(0.0);
    ASSERT_TRUE(turn.latest_in_s);
    EXPECT_EQ(*turn.latest_in_s, 50.0) << "out and back along the first leg";
    EXPECT_FALSE(turn.path_can_be_flown);
    trial.prediction.cruise.energy.energy_wh *= 2.0;
    trial.charge_for(202.0);
    EXPECT_EQ(trial.turn(0.0).latest_in_s, 50.0) << "twice the planned power, home as well";
    trial.charge_for(101.0);
    EXPECT_EQ(trial.turn(0.0).latest_in_s, 20.0) << "a quarter of 101 s, in steps of 10";
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
    trial.cruise_for(100.0);
    EXPECT_FALSE(trial.turn(100.0).latest_in_s) << "100 s from home";
    trial.charge_for(110.0);
    EXPECT_TRUE(trial.turn(100.0).latest_in_s);
    trial.prediction.landing_s = 20.0;
    trial.prediction.landing.energy_wh = 10.0 * 20.0 / 3600.0;
    EXPECT_FALSE(trial.turn(100.0).latest_in_s) << "the landing counts";
}

/// The way home began on the path, wherever the aircraft was.
TEST(TurnHome, CountsHowFarItHasLeftThePath) {
    Trial trial;
    trial.charge_for(150.0);
    EXPECT_TRUE(trial.turn(100.0).latest_in_s) << "100 s from home";
    trial.prediction.away = {600.0, 0.0};
    EXPECT_TRUE(trial.turn(100.0).latest_in_s) << "117 s";
    trial.prediction.away = {0.0, 600.0};
    EXPECT_FALSE(trial.turn(100.0).latest_in_s) << "160 s";
}

/// A cruise beyond the mission's was predicted as a landing from now, 7 km away.
TEST(TurnHome, OfACompletedPathIsTheWayFromWhereTheAircraftIs) {
    auto input = input_from_model(model_of_high_and_low_flights(), "model.toml", 300.0);
    input.remaining_s.reset();
    input.model.physical = test::made_up_wing();
    input.path = std::make_shared<path::PathForecast>(path::PlannedPath{out_and_on(), {}, *input.model.physical});
    path::PathFix fix;
    fix.path_time_s = 200.0;
    Remarks remarks;
    const auto there = predict_energy(input, after(25.0, 260.0), fix, remarks);
    EXPECT_EQ(there.remaining_s, 0.0);
    fix.is_on_path = false;
    fix.at = {1000.0, 6000.0};  // the path ends 1 km north and 1 km east
    const auto away = predict_energy(input, after(25.0, 260.0), fix, remarks);
    EXPECT_NEAR(away.remaining_s, std::hypot(1000.0, 6000.0) / 10.0, 1e-6);
    EXPECT_GT(away.remaining_energy.energy_wh, there.remaining_energy.energy_wh);
    EXPECT_GT(away.overtime_s.value(), 50.0);
    EXPECT_NE(remarks.warnings.back().find("that of the way home, from 5000 m off the path's end"), std::string::npos);
}

TEST(TurnHome, WithoutAPathItIsTheLatestLanding) {
    Trial trial;
    trial.prediction.landing_s = 50.0;
    trial.prediction.landing.energy_wh = 10.0 * 50.0 / 3600.0;
    const auto land = [&] { return latest_return(trial.input, trial.prediction, trial.now); };
    trial.charge_for(260.0);
    EXPECT_TRUE(land().path_can_be_flown) << "200 s of cruise and the landing";
    trial.charge_for(155.0);
    EXPECT_EQ(land().latest_in_s, 100.0) << "in steps of 10 s";
    EXPECT_FALSE(land().path_can_be_flown);
    trial.charge_for(40.0);
    EXPECT_FALSE(land().latest_in_s);
}

TEST(TurnHome, ACruiseBeyondTheMissionsContinuesToTheReserve) {
    Trial trial;
    trial.prediction.remaining_power.clear();
    trial.prediction.cruise.energy.energy_wh = 0.0;
    trial.prediction.cruise.remaining_mean_w = 20.0;
    trial.prediction.overtime_s = 30.0;
    trial.prediction.landing_s = 50.0;
    trial.prediction.landing.energy_wh = 10.0 * 50.0 / 3600.0;
    trial.charge_for(255.0);
    const auto land = latest_return(trial.input, trial.prediction, trial.now);
    EXPECT_EQ(land.latest_in_s, 100.0) << "205 s at 10 W are 102.5 s at 20 W, in steps of 10 s";
    EXPECT_FALSE(land.path_can_be_flown);
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
    const auto curve = predict_soc_curve(basis, prediction, {90.0, 0.0}, 50.0);
    EXPECT_NEAR(curve.time_s.back(), 1950.0, 1e-6);
    EXPECT_NEAR(curve.value.back(), 35.0, 1e-6) << "5.5 Wh of 10";
    EXPECT_LT(curve.time_s.size(), 120U);
    EXPECT_LT(predict_soc_curve(basis, prediction, {20.0, 0.0}, 50.0).time_s.back(), 50.0 + 721.0) << "2 Wh at 10 W";
}

}  // namespace
}  // namespace flightwatt::live

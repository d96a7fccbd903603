#include "answer/answer.h"

#include "base/atomic_file.h"
#include "battery/battery_toml.h"
#include "helpers/made_up_flights.h"
#include "helpers/test_paths.h"

#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::answer {
namespace {

using flight::Phase;
using testing::HasSubstr;

/// An aircraft of constant power on a pack of 10 V without resistance.
class AnswerTest : public testing::Test {
  protected:
    KnownAircraft aircraft_of(double cruise_w, double capacity_ah, std::size_t flights = 4) {
        KnownAircraft aircraft;
        aircraft.model = test::published_model();
        for (std::size_t i = 0; i < flights; ++i) aircraft.model.flights.push_back({"flight" + std::to_string(i), {}});
        for (auto& phase : aircraft.model.phases.values) {
            phase.fourier = {0.01, cruise_w, {}, {}};
            phase.duration_s = 60.0;
            if (flights > 1) phase.level_spread = {flights, 0.05 * cruise_w, 0.0, 1.0};
        }
        aircraft.model_file = folder_ / "model.toml";
        aircraft.battery_file = folder_ / "pack.toml";
        battery::Battery pack{"pack", 10.0, 0.0, capacity_ah};
        write_file_atomically(aircraft.model_file, to_toml(aircraft.model));
        write_file_atomically(aircraft.battery_file, to_toml(pack));
        aircraft.pack.capacity_ah = known(capacity_ah, "as given");
        aircraft.flights = {{"flight0", 60.0, 12.0, 500.0}};
        return aircraft;
    }

    std::filesystem::path folder_ = test::scratch_dir();
};

TEST_F(AnswerTest, TimeIsTheChargeAboveTheReserveOverThePower) {
    const auto endurance = answer_endurance(aircraft_of(100.0, 5.0), {.reserve_soc_percent = 20.0});
    EXPECT_NEAR(endurance.power_w.value.value(), 100.0, 1e-6);
    EXPECT_EQ(endurance.power_w.basis, "measured on 4 flights");
    EXPECT_NEAR(endurance.time_s.value.value(), 0.8 * 5.0 * 10.0 / 100.0 * 3600.0, 1.0);
    EXPECT_LT(endurance.time_95_s.value.value(), 0.97 * *endurance.time_s.value) << "flights differ by 5 %";
    EXPECT_GT(endurance.time_95_s.value.value(), 0.8 * *endurance.time_s.value);
}

TEST_F(AnswerTest, PowerRestsOnTheFlightsWhoseCruiseIsWhole) {
    auto aircraft = aircraft_of(100.0, 5.0);
    aircraft.model.phases[Phase::cruise].flights = 1;
    aircraft.model.phases[Phase::cruise].level_spread.reset();
    write_file_atomically(aircraft.model_file, to_toml(aircraft.model));
    const auto endurance = answer_endurance(aircraft, {});
    EXPECT_EQ(endurance.power_w.basis, "measured on 1 flight");
    EXPECT_THAT(endurance.time_95_s.unknown, HasSubstr("in cruise, as one flight alone shows the whole of it"));
}

TEST_F(AnswerTest, OneFlightHasNoTimeIn95Of100) {
    const auto endurance = answer_endurance(aircraft_of(100.0, 5.0, 1), {});
    EXPECT_TRUE(endurance.time_s.value);
    EXPECT_FALSE(endurance.time_95_s.value);
    EXPECT_EQ(endurance.time_95_s.unknown, "one flight does not show how flights differ; two more would");
}

TEST_F(AnswerTest, WithoutDrawnFlightsTheTimeIsTheSameAndThatIn95Of100Unknown) {
    const auto aircraft = aircraft_of(100.0, 5.0);
    const auto drawn = answer_endurance(aircraft, {});
    const auto modelled = answer_endurance(aircraft, {.draws_flights = false});
    EXPECT_EQ(*modelled.time_s.value, *drawn.time_s.value);
    EXPECT_EQ(*modelled.distance_m.value, *drawn.distance_m.value);
    EXPECT_EQ(modelled.time_95_s.unknown, "no flights were drawn");
    EXPECT_GT(*modelled.cruise_s, *drawn.cruise_s) << "half of the flights reach it";
}

TEST_F(AnswerTest, NoTimeWithoutACapacity) {
    auto aircraft = aircraft_of(100.0, 5.0);
    aircraft.pack.capacity_ah = unknown("no label");
    const auto endurance = answer_endurance(aircraft, {});
    EXPECT_TRUE(endurance.power_w.value);
    for (const auto& answered : {endurance.time_s, endurance.time_95_s, endurance.distance_m}) {
        EXPECT_FALSE(answered.value);
        EXPECT_EQ(answered.unknown, "no label");
    }
}

TEST_F(AnswerTest, TimeOfAColdPackStatesWhatItRestsOn) {
    auto aircraft = aircraft_of(100.0, 5.0);
    aircraft.pack.asked_temperature_c = -5.0;
    aircraft.pack.resistance_at_ohm = known(0.04, "assumed: 3 % a kelvin colder");
    const auto cold = answer_endurance(aircraft, {});
    EXPECT_THAT(cold.time_s.basis, HasSubstr("; the pack's resistance at -5 degC: assumed: 3 % a kelvin colder"));
    EXPECT_THAT(cold.notes, testing::Contains(HasSubstr("capacity is assumed to be unchanged at -5 degC")));
    aircraft.pack.resistance_at_ohm = unknown("no log states a temperature");
    EXPECT_EQ(answer_endurance(aircraft, {}).time_s.unknown, "no log states a temperature");
}

TEST_F(AnswerTest, WindShortensTheWayOutAndBackAndNotTheTime) {
    const auto aircraft = aircraft_of(100.0, 5.0);
    const auto calm = answer_endurance(aircraft, {});
    const auto windy = answer_endurance(aircraft, {.wind_m_per_s = 6.0});
    const double cruise_s = *calm.time_s.value - 120.0;
    EXPECT_NEAR(calm.distance_m.value.value(), 12.0 * cruise_s, 1e-6 * cruise_s);
    EXPECT_EQ(windy.time_s.value, calm.time_s.value);
    const double out_m = 0.5 * windy.distance_m.value.value();
    EXPECT_NEAR(out_m / (12.0 - 6.0) + out_m / (12.0 + 6.0), cruise_s, 1e-6 * cruise_s);
    EXPECT_NEAR(std::pow(windy.distance_across_m.value() / cruise_s, 2), 144.0 - 36.0, 1e-6);
    EXPECT_FALSE(calm.distance_across_m);
    EXPECT_EQ(windy.return_airspeed_m_per_s.value, windy.airspeed_m_per_s.value);
}

TEST_F(AnswerTest, NoWayBackAgainstAWindAsFastAsTheAircraft) {
    const auto endurance = answer_endurance(aircraft_of(100.0, 5.0), {.wind_m_per_s = 12.0});
    EXPECT_FALSE(endurance.distance_m.value);
    EXPECT_THAT(endurance.distance_m.unknown, HasSubstr("makes no way against a wind of 12.0 m/s"));
}

TEST_F(AnswerTest, ASpeedThatNoFlightFlewIsCalledAMean) {
    auto aircraft = aircraft_of(100.0, 5.0);
    EXPECT_EQ(answer_endurance(aircraft, {}).airspeed_m_per_s.basis,
              "assumed: the ground speed of the flights, as in calm air");
    aircraft.flights = {{"hover", 60.0, 0.2, 5.0}, {"away", 60.0, 12.0, 500.0}};
    EXPECT_THAT(answer_endurance(aircraft, {}).airspeed_m_per_s.basis,
                HasSubstr("the mean ground speed of flights at 0.2 to 12.0 m/s"));
}

TEST_F(AnswerTest, PowerOfOtherPacksIsNamed) {
    auto aircraft = aircraft_of(100.0, 5.0);
    EXPECT_THAT(answer_endurance(aircraft, {}).notes, testing::Not(testing::Contains(HasSubstr("other circuits"))));
    aircraft.flights.front().pack_percent = 75.0;
    EXPECT_THAT(answer_endurance(aircraft, {}).notes,
                testing::Contains(HasSubstr("of which packs of other circuits gave 25 % in the flights")));
}

/// A VTOL that hovers for a tenth of its cruises was answered with the distance of the whole at its airspeed.
TEST_F(AnswerTest, AVtolMakesNoWayInTheHoverOfItsCruise) {
    auto aircraft = aircraft_of(100.0, 5.0, 2);
    aircraft.model.physical = mechanical::PhysicalModel{};
    aircraft.model.physical->mean_airspeed_m_per_s = 18.0;
    const auto distance_m = [&] { return answer_endurance(aircraft, {}).distance_m.value.value(); };
    const double on_wing_m = distance_m();
    aircraft.flights = {{.flight = "a", .cruise_s = 600.0, .wing_s = 500.0},
                        {.flight = "b", .cruise_s = 400.0, .wing_s = 400.0}};
    EXPECT_NEAR(distance_m(), 0.9 * on_wing_m, 1e-6 * on_wing_m);
    EXPECT_THAT(answer_endurance(aircraft, {}).notes,
                testing::Contains(HasSubstr("10 % of the cruise are hover and transitions")));
    aircraft.flights = {{.flight = "a", .cruise_s = 600.0, .wing_s = 0.0}};
    const auto hover = answer_endurance(aircraft, {});
    EXPECT_THAT(hover.notes, testing::Contains(HasSubstr("never are on the wing")));
    EXPECT_TRUE(hover.is_hover);
    EXPECT_FALSE(hover.distance_m.value) << "100 m, at the 0.04 m/s of its drift";
}

/// The mean power of flights with 0 to 1.2 kg was answered without a word.
TEST_F(AnswerTest, NamesThePayloadsThatItAverages) {
    auto aircraft = aircraft_of(100.0, 5.0, 2);
    const auto averaged = testing::Contains(HasSubstr("power and time are of their mean"));
    aircraft.flights = {{.flight = "a", .cruise_s = 600.0, .payload_kg = 0.5},
                        {.flight = "b", .cruise_s = 400.0, .payload_kg = 0.5}};
    EXPECT_THAT(answer_endurance(aircraft, {}).notes, testing::Not(averaged));
    aircraft.flights[1].payload_kg = 0.0;
    EXPECT_THAT(answer_endurance(aircraft, {}).notes, averaged);
    aircraft.flights[1].payload_kg.reset();
    EXPECT_THAT(answer_endurance(aircraft, {}).notes, testing::Contains(HasSubstr("kg, and 1 state no payload")));
    aircraft.flights[0].payload_kg.reset();
    EXPECT_THAT(answer_endurance(aircraft, {}).notes, testing::Not(averaged));
}

TEST_F(AnswerTest, NoDistanceOfAHover) {
    auto aircraft = aircraft_of(100.0, 5.0);
    aircraft.model.is_rotorcraft = true;
    aircraft.flights.front().ground_speed_m_per_s = 2.9;
    EXPECT_TRUE(answer_endurance(aircraft, {}).is_hover);
    EXPECT_FALSE(answer_endurance(aircraft, {}).distance_m.value);
    aircraft.flights.front().ground_speed_m_per_s = 3.1;
    EXPECT_FALSE(answer_endurance(aircraft, {}).is_hover);
    EXPECT_TRUE(answer_endurance(aircraft, {}).distance_m.value);
    aircraft.flights.front().ground_speed_m_per_s.reset();
    EXPECT_FALSE(answer_endurance(aircraft, {}).is_hover) << "without a speed it may have flown away";
    EXPECT_EQ(answer_endurance(aircraft, {}).distance_m.unknown,
              "the logs have neither airspeed nor position; a flight with GPS shows it");
}

TEST_F(AnswerTest, ARotorcraftReturnsAgainstTheWindAtTheGroundSpeedItFlew) {
    auto aircraft = aircraft_of(100.0, 5.0);
    aircraft.model.is_rotorcraft = true;
    aircraft.flights.front().ground_speed_m_per_s = 5.0;
    const auto home = [&](const Question& question) {
        return answer_endurance(aircraft, question).return_airspeed_m_per_s;
    };
    EXPECT_EQ(home({}).value, std::optional(5.0));
    aircraft.model.physical.emplace().airspeed_m_per_s = {0.0, 10.0};
    EXPECT_EQ(home({.wind_m_per_s = 3.0}).value, std::optional(8.0));
    EXPECT_EQ(home({.wind_m_per_s = 3.0}).basis, "assumed: 5.0 m/s over ground as in the flights");
    EXPECT_THAT(home({.wind_m_per_s = 6.0}).basis, HasSubstr("extrapolated"));
    EXPECT_THAT(home({.wind_m_per_s = 8.0}).unknown,
                HasSubstr("13.0 m/s of airspeed are beyond what its flights show"));
    EXPECT_EQ(home({.airspeed_m_per_s = 9.0, .wind_m_per_s = 3.0}).value, std::optional(9.0));
    aircraft.flights.front().ground_speed_m_per_s.reset();
    EXPECT_EQ(home({.wind_m_per_s = 3.0}).value, std::optional(8.0));
    EXPECT_THAT(home({}).basis, HasSubstr("assumed, as slow as autopilots return"));
}

TEST_F(AnswerTest, APayloadThatTheFlightsDoNotShowIsUnknownWithTheRemedy) {
    const auto endurance = answer_endurance(aircraft_of(100.0, 5.0), {.payload_kg = 0.5});
    EXPECT_FALSE(endurance.power_w.value);
    EXPECT_THAT(endurance.power_w.unknown, HasSubstr("takeoff_mass_kg"));
    EXPECT_FALSE(endurance.time_s.value);
}

TEST_F(AnswerTest, APayloadOfARotorcraftOfKnownMassRaisesItsPowerByMomentumTheory) {
    auto aircraft = aircraft_of(100.0, 5.0);
    aircraft.model.is_rotorcraft = true;
    write_file_atomically(aircraft.model_file, to_toml(aircraft.model));
    const auto endurance = answer_endurance(aircraft, {.payload_kg = 1.0, .takeoff_mass_kg = 2.0});
    EXPECT_NEAR(endurance.power_w.value.value(), 100.0 * std::pow(1.5, 1.5), 0.5);
    EXPECT_THAT(endurance.notes, testing::Contains(HasSubstr("assumed")));
}

}  // namespace
}  // namespace flightwatt::answer

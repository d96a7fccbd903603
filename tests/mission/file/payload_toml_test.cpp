#include "helpers/path_missions.h"
#include "helpers/rejected.h"
#include "mission/mission_file.h"
#include "mission/simulation.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using mechanical::PowerTerm;
using test::cruise_w;
using testing::HasSubstr;

/// A model of two flights at 200 W; its physical part has these terms, of 100 W each at 1 m/s, but climb.
mechanical::MechanicalModel model_of(const std::vector<PowerTerm>& terms, bool is_rotorcraft) {
    auto model = mechanical::read_mechanical_model(test::source_dir() / "fits" / "mechanical" / "opterra-table1.toml");
    model.is_rotorcraft = is_rotorcraft;
    for (auto& phase : model.phases.values) {
        phase.fourier = {0.01, 200.0, {}, {}};
        phase.level_spread = mechanical::VarianceComponents{2, 6.0, 3.0, 30.0};
    }
    if (terms.empty()) return model;
    auto& physical = model.physical.emplace(test::made_up_wing());
    physical.bins = 100;
    physical.bin_s = 30.0;
    physical.correlation_s = 60.0;
    physical.terms = terms;
    physical.coefficients = {};
    for (const auto term : terms) physical.coefficients[term] = term == PowerTerm::payload ? 120.0 : 100.0;
    physical.covariance.assign(terms.size(), std::vector<double>(terms.size(), 0.0));
    physical.airspeed_m_per_s = {0.0, 1.0};
    physical.cubic_mean_airspeed_m_per_s = 1.0;
    return model;
}

Mission mission_on(const mechanical::MechanicalModel& model, const std::string& lines) {
    const auto folder = test::scratch_dir();
    test::write_text(folder / "model.toml", mechanical::to_toml(model));
    return std::get<Mission>(parse_mission(
        "mechanical = \"model.toml\"\nbattery = { voltage_v = 23, resistance_ohm = 0, capacity_ah = 50 }\n" + lines,
        folder / "m.toml"));
}

TEST(PayloadToml, OfARotorcraftWithoutTermsIsThatOfMassToThePowerOfOneAndAHalf) {
    for (const auto& terms : {std::vector<PowerTerm>{}, {PowerTerm::constant, PowerTerm::climb}}) {
        const auto mission = mission_on(model_of(terms, true), "payload_kg = 2\ntakeoff_mass_kg = 2.5\n");
        const double factor = std::pow(4.5 / 2.5, 1.5);
        EXPECT_NEAR(cruise_w(mission), 200.0 * factor, 1e-9);
        ASSERT_EQ(mission.setup.notes.size(), 1U);
        EXPECT_THAT(mission.setup.notes[0], HasSubstr("assumed to be proportional to mass^1.5"));
        ASSERT_TRUE(mission.setup.payload) << "what the powers rest on";
        EXPECT_TRUE(mission.setup.payload->is_assumed);
        EXPECT_FALSE(mission_on(model_of(terms, true), "payload_kg = 0\ntakeoff_mass_kg = 2.5\n").setup.payload)
            << "as flown";
        const double assumed_w = 0.2 * 200.0 * (factor - 1.0);
        EXPECT_NEAR(mission.setup.mechanical->phases[flight::Phase::landing].level_spread->between_flight_sd_w,
                    std::hypot(6.0 * factor, assumed_w), 1e-9);
    }
}

TEST(PayloadToml, OfARotorcraftWithoutTermsChangesThePowerAtAnAirspeedToo) {
    const auto model = model_of({PowerTerm::constant}, true);
    const auto empty = mission_on(model, "airspeed_m_per_s = 1\n");
    const auto loaded = mission_on(model, "airspeed_m_per_s = 1\npayload_kg = 1\ntakeoff_mass_kg = 2\n");
    EXPECT_NEAR(cruise_w(loaded) / cruise_w(empty), std::pow(1.5, 1.5), 1e-9);
    EXPECT_GT(*loaded.setup.cruise_level->sd_w / cruise_w(loaded), *empty.setup.cruise_level->sd_w / cruise_w(empty));
}

TEST(PayloadToml, TakesTheMassThatTheFlightsState) {
    auto model = model_of({PowerTerm::constant}, true);
    model.physical->load = {0.5, mechanical::RotorLoading{2.0, 0.4}};
    model.physical->payload_kg = {0.5, 0.5};
    EXPECT_NEAR(cruise_w(mission_on(model, "payload_kg = 3\n")), 200.0 * std::pow(5.0 / 2.5, 1.5), 1e-9);
    EXPECT_NEAR(cruise_w(mission_on(model, "payload_kg = 0\n")), 200.0 * std::pow(2.0 / 2.5, 1.5), 1e-9);
}

/// 120 W/kg at 0.25 kg.
TEST(PayloadToml, FollowsTheTermAndBeyondTheFlownPayloadsThePowerLaw) {
    auto model = model_of({PowerTerm::constant, PowerTerm::payload}, true);
    model.physical->load.payload_kg = 0.25;
    model.physical->payload_kg = {0.0, 0.5};
    const double flown_w = 100.0 + 0.25 * 120.0;
    const auto times = [&](const std::string& payload_kg) {
        return cruise_w(mission_on(model, "payload_kg = " + payload_kg + "\n")) / 200.0;
    };
    EXPECT_NEAR(times("0.5"), (100.0 + 0.5 * 120.0) / flown_w, 1e-9);
    EXPECT_NEAR(times("2"), std::pow(1.0 + 1.75 / (1.5 * flown_w / 120.0), 1.5), 1e-9);
    model.is_rotorcraft = false;
    EXPECT_NEAR(times("2"), (100.0 + 2.0 * 120.0) / flown_w, 1e-9);
}

/// Flights with 0 to 1.2 kg differed by 17 %, with a payload each known to 2 %: a stated payload had both.
TEST(PayloadToml, LeavesNothingOfTheSpreadOfTheFlightsPayloads) {
    auto model = model_of({PowerTerm::constant, PowerTerm::payload}, true);
    model.phases[flight::Phase::cruise].level_spread = mechanical::VarianceComponents{6, 40.0, 3.0, 30.0};
    const auto sd_w = [&] {
        const auto mission = mission_on(model, "payload_kg = 0\n");
        return mission.setup.mechanical->phases[flight::Phase::cruise].level_spread->between_flight_sd_w /
               cruise_w(mission);
    };
    const double as_flown = sd_w();
    model.physical->payload_kg = Interval{0.0, 1.0};
    model.physical->load.payload_kg = 0.5;
    EXPECT_NEAR(sd_w(), 0.04, 1e-9) << "of 5 degrees of freedom, as 6 flights have";
    EXPECT_GT(as_flown, 0.04);
    model.physical->level_sd = 0.4;
    EXPECT_NEAR(sd_w(), as_flown, 1e-9) << "no more than between the flights";
}

TEST(PayloadToml, OfAWingIsThatOfItsInducedDrag) {
    const auto model = model_of({PowerTerm::drag, PowerTerm::induced}, false);
    const auto mission = mission_on(model, "payload_kg = 1\ntakeoff_mass_kg = 2\n");
    EXPECT_NEAR(cruise_w(mission), 200.0 * (100.0 + 100.0 * 2.25) / 200.0, 1e-9);
    EXPECT_THAT(mission.setup.notes.at(0), HasSubstr("mass^2"));
}

TEST(PayloadToml, IsRefusedWhereItsEffectIsUnknown) {
    const auto refusal = [](const mechanical::MechanicalModel& model, const std::string& lines) {
        return test::rejected([&] { mission_on(model, lines); });
    };
    const std::string unknown = "does not know the effect of payload";
    EXPECT_THAT(refusal(model_of({PowerTerm::constant}, true), "payload_kg = 1\n"), HasSubstr(unknown));
    EXPECT_THAT(refusal(model_of({PowerTerm::drag}, false), "payload_kg = 1\ntakeoff_mass_kg = 2\n"),
                HasSubstr(unknown));
    EXPECT_THAT(refusal(model_of({}, false), "payload_kg = 1\ntakeoff_mass_kg = 2\n"), HasSubstr(unknown));
    EXPECT_THAT(refusal(model_of({}, true), "takeoff_mass_kg = 2\n"), HasSubstr("belongs to payload_kg"));
}

// Grams for kilograms gave a megawatt, or a payload without effect.
TEST(PayloadToml, RefusesMassesThatCannotBeKilograms) {
    const auto model = model_of({}, true);
    EXPECT_THAT(test::rejected([&] { mission_on(model, "payload_kg = 0.5\ntakeoff_mass_kg = 2900\n"); }),
                HasSubstr("2900 kg cannot fly with the 200 W of the model's cruise; give the mass in kilograms"));
    EXPECT_THAT(test::rejected([&] { mission_on(model, "payload_kg = 500\ntakeoff_mass_kg = 2.5\n"); }),
                HasSubstr("a payload of 500 kg on an aircraft of 2.5 kg; give it in kilograms"));
}

// A rotorcraft that hovered was predicted to fly at any airspeed with the power of its hover.
TEST(PayloadToml, RefusesAirspeedsThatAModelWithoutDragCannotKnow) {
    const auto model = model_of({PowerTerm::constant}, true);
    EXPECT_NO_THROW(mission_on(model, "airspeed_m_per_s = 8\n"));
    EXPECT_THAT(test::rejected([&] { mission_on(model, "airspeed_m_per_s = 8.5\n"); }),
                HasSubstr("airspeed_m_per_s = 8.5 is beyond what the model's flights flew; they flew 0 to 1 m/s"));
}

}  // namespace
}  // namespace flightwatt::mission

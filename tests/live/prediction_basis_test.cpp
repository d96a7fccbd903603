#include "live/prediction_basis.h"

#include "base/error.h"
#include "helpers/test_paths.h"
#include "mission/mission_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

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
    EXPECT_EQ(basis.limits.reserve_soc_percent, setup.reserve_soc_percent);
    ASSERT_TRUE(basis.battery);
    EXPECT_EQ(basis.battery->capacity_ah, setup.battery.capacity_ah);
    EXPECT_FALSE(path_input_from_mission(setup, "survey-path.toml").battery);
}

/// As in drawn flights: what the mission states is known, unless it says how far it is not.
TEST(PredictionBasis, TheCapacityIsAsUncertainAsTheMissionSays) {
    auto setup = setup_in("missions/synthetic/survey-path.toml");
    const auto interval_of = [&] { return input_from_mission(setup, "m.toml").battery->intervals.capacity_ah; };
    setup.capacity_is_stated = false;
    setup.battery.intervals.capacity_ah = battery::Interval{0.9, 1.2};
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
    EXPECT_THAT(basis.no_prediction_reason, HasSubstr("has no spread"));
    EXPECT_EQ(basis.cruise_s, setup.duration_s[flight::Phase::cruise]);
    EXPECT_THROW(path_input_from_mission(setup, "phased.toml"), InputError);
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

}  // namespace
}  // namespace flightwatt::live

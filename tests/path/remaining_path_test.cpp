#include "path/remaining_path.h"

#include "base/error.h"
#include "helpers/made_up_paths.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

const FlightPath& path() {
    static const FlightPath made{{test::path_element(Leg{1300.0, 0.0}), test::path_element(Circles{80.0, 3.0}),
                                  test::path_element(Hold{60.0}), test::path_element(Leg{1300.0, 180.0}, 13.0, 50.0)}};
    return made;
}

double energy_j(const PathTrajectory& flown) {
    double energy_j = 0.0;
    for (const auto& piece : flown.pieces) energy_j += power_w(test::made_up_wing(), piece.motion) * piece.time_s;
    return energy_j;
}

/// Nothing of its power is known.
mechanical::FlightProgress unseen_flight() {
    mechanical::FlightProgress flown;
    flown.until_s = 100.0;
    return flown;
}

TEST(RemainingPath, IsWhatTheTimeSoFarLeaves) {
    const auto flown = compute_trajectory(path(), {4.0, 90.0});
    for (const double time_s : {0.0, 40.0, 120.0, 200.0, flown.duration_s - 1.0, flown.duration_s}) {
        const auto rest = remaining_trajectory(flown, position_at(flown, time_s));
        EXPECT_NEAR(rest.duration_s, flown.duration_s - time_s, 1e-9);
        double of_elements_s = 0.0;
        for (const double element_s : rest.element_s) of_elements_s += element_s;
        EXPECT_NEAR(of_elements_s, rest.duration_s, 1e-9);
    }
    EXPECT_NEAR(energy_j(remaining_trajectory(flown, position_at(flown, 0.0))), energy_j(flown), 1e-9);
    const auto climbing = remaining_trajectory(flown, position_at(flown, flown.duration_s - 10.0));
    EXPECT_NEAR(energy_j(climbing), 10.0 * power_w(test::made_up_wing(), flown.pieces.back().motion), 1e-9);
}

TEST(RemainingPath, BeginsAtTheSamePlaceInAnotherWind) {
    const auto calm = compute_trajectory(path(), {});
    const auto place = position_at(calm, 50.0);
    EXPECT_EQ(place.element, 0U);
    EXPECT_NEAR(place.part, 0.5, 1e-12);
    const Wind tail_wind{5.0, 180.0};
    const auto rest = remaining_trajectory(compute_trajectory(path(), tail_wind), place);
    EXPECT_NEAR(rest.element_s[0], 0.5 * 1300.0 / 18.0, 1e-9);
}

TEST(RemainingPath, TakesWhatTheModelSays) {
    const PlannedPath plan{path(), {}, test::made_up_wing()};
    const auto flown = compute_trajectory(path(), {});
    const auto place = position_at(flown, 150.0);
    const auto rest = PathForecast(plan).predict(unseen_flight(), place);
    EXPECT_NEAR(rest.duration_s, flown.duration_s - 150.0, 1e-9);
    EXPECT_NEAR(rest.cruise.energy.energy_wh, energy_j(remaining_trajectory(flown, place)) / 3600.0, 1e-9);
}

TEST(RemainingPath, SpreadOfTheWindWidensTheInterval) {
    const Wind wind{4.0, 0.0};
    auto spread = wind;
    spread.speed_sd_m_per_s = 1.0;
    const PathPosition place{3, 0.0};  // southward, the wind from behind
    const auto known = PathForecast({path(), wind, test::made_up_wing()}).predict(unseen_flight(), place);
    const auto drawn = PathForecast({path(), spread, test::made_up_wing()}).predict(unseen_flight(), place);
    // The time is 1300 m over the ground speed, whose mean over winds is a little longer.
    EXPECT_GT(drawn.cruise.energy.energy_wh, known.cruise.energy.energy_wh);
    EXPECT_LT(drawn.cruise.energy.energy_wh, 1.005 * known.cruise.energy.energy_wh);
    // The climb's energy is the same however long it takes; the rest goes with the time.
    const double level_w = 0.01 * 13.0 * 13.0 * 13.0;
    const double sd_wh = 0.5 * level_w * (1300.0 / 16.0 - 1300.0 / 18.0) / 3600.0;
    EXPECT_NEAR(drawn.cruise.energy.variance_wh2 - known.cruise.energy.variance_wh2, sd_wh * sd_wh,
                0.03 * sd_wh * sd_wh);
    EXPECT_EQ(drawn.infeasible_fraction, 0.0);
}

TEST(RemainingPath, CountsTheWindsThatForbidIt) {
    const PathPosition place{3, 0.0};  // southward
    Wind wind{8.5, 180.0};             // against it
    wind.speed_sd_m_per_s = 4.0;       // 13 m/s are 1.125 sd more: of 7 equally likely winds the fastest
    const auto rest = PathForecast({path(), wind, test::made_up_wing()}).predict(unseen_flight(), place);
    EXPECT_NEAR(rest.infeasible_fraction, 1.0 / 7.0, 1e-12);
    wind.from_deg = 0.0;  // from behind: what was northward before the place does not matter
    EXPECT_EQ(PathForecast({path(), wind, test::made_up_wing()}).predict(unseen_flight(), place).infeasible_fraction,
              0.0);
    const Wind hopeless{20.0, 180.0, 3.0};
    EXPECT_THROW(PathForecast({path(), hopeless, test::made_up_wing()}).predict(unseen_flight(), place), NoResultError);
}

TEST(RemainingPath, GetsNothingBackFromADescent) {
    const FlightPath made{{test::path_element(Hold{100.0}), test::path_element(Hold{100.0}, 13.0, -400.0)}};
    const PlannedPath plan{made, {}, test::made_up_wing()};
    const auto rest = PathForecast(plan).predict(unseen_flight(), {0, 0.0});
    EXPECT_NEAR(rest.cruise.energy.energy_wh, 100.0 * 0.01 * 13.0 * 13.0 * 13.0 / 3600.0, 1e-9);
    ASSERT_EQ(rest.trajectory.pieces.size(), 2U);
    EXPECT_EQ(power_w(plan.power, rest.trajectory.pieces[1].motion), 0.0);
}

TEST(RemainingPath, OfNothingIsNothing) {
    const PlannedPath plan{path(), {3.0, 45.0, 1.0, 10.0}, test::made_up_wing()};
    const auto flown = compute_trajectory(path(), plan.wind);
    const auto rest = PathForecast(plan).predict(unseen_flight(), position_at(flown, flown.duration_s));
    EXPECT_EQ(rest.duration_s, 0.0);
    EXPECT_EQ(rest.cruise.energy.energy_wh, 0.0);
}

}  // namespace
}  // namespace flightwatt::path

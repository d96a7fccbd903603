#include "mission/sampling/landing_search.h"

#include "helpers/generated_missions.h"
#include "mission/feasibility_limits.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

/// Packs from one that most flights empty to one that lands nearly full, by large and by small steps.
TEST(LandingSearch, HasTheReserveAndTheQuantileOfAllFlightsSimulated) {
    for (unsigned seed = 1; seed <= 12; ++seed) {
        const auto made = test::generated_mission(seed, false);
        auto mission = with_minimum_energy_schedule(made.problem);
        mission.setup.reserve_soc_percent = seed % 4 == 0 ? 0.0 : 3.0 * static_cast<double>(seed % 10);
        const double capacity_ah = mission.setup.battery.capacity_ah;
        LandingSearch search(made.probability);
        for (const double times : {1.0, 4.0, 0.7, 1.1, 1.101, 1.0999, 1.12, 2.0}) {
            const auto at = with_capacity(mission, times * capacity_ah);
            const auto uncertainty = collect_uncertainty(at.setup);
            const auto expected = draw_landings_until_known(at, uncertainty, made.probability);
            const auto landings = search.landings(at, uncertainty);
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << made.kind << ", times " << times);
            EXPECT_EQ(landings.quantile_percent(made.probability), expected.quantile_percent(made.probability));
            EXPECT_EQ(landings.below(), expected.below());
            EXPECT_EQ(landings.nominal_percent, expected.nominal_percent);
            EXPECT_EQ(landings.left_percent.size(), expected.left_percent.size());
        }
    }
}

TEST(LandingSearch, IsTheMissionAsStatedWhereNothingVaries) {
    auto mission = with_minimum_energy_schedule(test::generated_mission(2, false).problem);
    FlightUncertainty nothing;
    EXPECT_EQ(LandingSearch(0.95).landings(mission, nothing).left_percent,
              draw_landings_until_known(mission, nothing, 0.95).left_percent);
}

}  // namespace
}  // namespace flightwatt::mission

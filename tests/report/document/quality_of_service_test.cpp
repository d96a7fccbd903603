#include "report/document/quality_of_service.h"

#include "helpers/paper_missions.h"
#include "mission/simulation.h"

#include <algorithm>
#include <iterator>

#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using test::paper_mission;

TEST(QosMap, IsThePapersGridAndEndsWhereTheMissionsEnd) {
    const auto map = qos_map(paper_mission("invariant-10fps-240bit").setup);
    ASSERT_TRUE(map);
    EXPECT_EQ(map->x.nodes.size(), 10U);
    EXPECT_EQ(map->y.nodes.size(), 13U);
    const auto at = [&](double fps, double key_bits) {
        const auto i = std::find(map->x.nodes.begin(), map->x.nodes.end(), fps) - map->x.nodes.begin();
        const auto j = std::find(map->y.nodes.begin(), map->y.nodes.end(), key_bits) - map->y.nodes.begin();
        return map->soc_percent[static_cast<std::size_t>(j * std::ssize(map->x.nodes) + i)];
    };
    for (const auto* name : {"invariant-10fps-240bit", "invariant-5.8fps-32bit", "invariant-32fps-448bit"}) {
        const auto mission = paper_mission(name);
        const auto& run = mission.schedule.front().run;
        EXPECT_NEAR(at(run[0].qos[0], run[1].qos[0]), *simulate(mission).summary.final_soc_percent, 1e-4) << name;
    }
}

TEST(QosMap, NeedsTwoParameters) {
    EXPECT_FALSE(qos_map(paper_mission("mechanical-only").setup));
    EXPECT_EQ(map_key(paper_mission("phased").setup), map_key(paper_mission("adaptive").setup));
    EXPECT_NE(map_key(paper_mission("phased").setup), map_key(paper_mission("computing-only").setup));
}

TEST(QosGrid, HasTheProfiledValuesWithTheirCurvesAndProbabilities) {
    const auto mission = paper_mission("invariant-10fps-240bit");
    const auto grid = qos_grid(mission.setup);
    ASSERT_TRUE(grid);
    EXPECT_EQ(grid->x.nodes, (std::vector<double>{5.8, 10.0, 25.0, 32.0}));
    ASSERT_EQ(grid->cells.size(), grid->x.nodes.size() * grid->y.nodes.size());
    const auto row = std::ranges::find(grid->y.nodes, 240.0) - grid->y.nodes.begin();
    const auto& cell = grid->cells[static_cast<std::size_t>(row) * grid->x.nodes.size() + 1];
    EXPECT_NEAR(*cell.simulation.summary.final_soc_percent, *simulate(mission).summary.final_soc_percent, 1e-3);
    EXPECT_GE(cell.simulation.curve.rows.size(), 40U);
    ASSERT_TRUE(cell.probability);
    EXPECT_LT(grid->cells.back().probability, *grid->cells.front().probability);
    EXPECT_FALSE(qos_grid(paper_mission("mechanical-only").setup));
}

}  // namespace
}  // namespace flightwatt::report

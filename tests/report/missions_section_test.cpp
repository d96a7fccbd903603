#include "report/missions_section.h"

#include "base/error.h"
#include "helpers/paper_missions.h"
#include "report/figures/qos_map.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using test::paper_mission;

using testing::HasSubstr;

std::vector<SimulatedMission> simulated(const std::vector<std::string>& names) {
    std::vector<mission::AnyMission> missions;
    for (const auto& name : names) missions.push_back(paper_mission(name));
    return simulate_for_report(std::move(missions));
}

TEST(QosMap, IsThePapersGridAndEndsWhereTheMissionsEnd) {
    const auto map = qos_map(paper_mission("invariant-10fps-240bit"));
    ASSERT_TRUE(map);
    EXPECT_EQ(map->x.nodes.size(), 10U);
    EXPECT_EQ(map->y.nodes.size(), 13U);
    const auto at = [&](double fps, double key_bits) {
        const auto i = std::find(map->x.nodes.begin(), map->x.nodes.end(), fps) - map->x.nodes.begin();
        const auto j = std::find(map->y.nodes.begin(), map->y.nodes.end(), key_bits) - map->y.nodes.begin();
        return map->at(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
    };
    for (const auto* name : {"invariant-10fps-240bit", "invariant-5.8fps-32bit", "invariant-32fps-448bit"}) {
        const auto mission = paper_mission(name);
        const auto& run = mission.schedule.front().run;
        EXPECT_NEAR(at(run[0].qos[0], run[1].qos[0]), *simulate(mission).summary.final_soc_percent, 1e-4)
            << name;
    }
}

TEST(QosMap, NeedsTwoParameters) {
    EXPECT_FALSE(qos_map(paper_mission("mechanical-only")));
    EXPECT_TRUE(have_same_map(paper_mission("phased"), paper_mission("adaptive")));
    EXPECT_FALSE(have_same_map(paper_mission("phased"), paper_mission("computing-only")));
}

TEST(MissionSections, HaveEachModelAndSoftwareOnce) {
    const auto sections = mission_sections(simulated({"phased", "adaptive", "computing-only"}), {});
    std::vector<std::string> figures;
    for (const auto& section : sections) {
        for (const auto& figure : section.figures) figures.push_back(figure.id);
    }
    EXPECT_THAT(figures, testing::ElementsAre("mission-model-1-curves", "profile-1", "schedules-soc",
                                              "quality-1", "quality-2"));
}

TEST(MissionSections, ShowWhereTheBatteryCannotDeliver) {
    auto weak = paper_mission("phased");
    weak.battery.resistance_ohm = 1.0;
    const auto sections = mission_sections(simulate_for_report({weak}), {});
    bool said = false;
    for (const auto& section : sections)
        said = said || section.html.find("cannot deliver") != std::string::npos;
    EXPECT_TRUE(said);
}

TEST(PublishedFigures, StandBesideOurs) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto published = read_published_figures(test::shared_dir() / "paper");
    EXPECT_EQ(published.soc.size(), 6U);
    EXPECT_EQ(published.soc_cells.size(), 108U);
    std::string captions;
    for (const auto& section : mission_sections(simulated({"computing-only", "phased"}), published)) {
        for (const auto& figure : section.figures) captions += figure.caption;
    }
    EXPECT_THAT(captions, HasSubstr("RMS difference take-off 0.009 W, cruise 0.005 W, landing 0.019 W"));
    EXPECT_THAT(captions, HasSubstr("Points: the paper's Fig. 3, digitised."));
    EXPECT_THAT(captions, HasSubstr("RMS difference over 108 cells 0.04 points"));
}

TEST(PublishedFigures, NameWhatIsMissing) {
    EXPECT_THROW(read_published_figures(test::scratch_dir()), InputError);
}

}  // namespace
}  // namespace flightwatt::report

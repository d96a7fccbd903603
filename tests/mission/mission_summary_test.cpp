#include "mission/mission_summary.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

MissionSummary outcome(const std::string& name, std::optional<double> soc, std::optional<double> depleted = {}) {
    MissionSummary summary;
    summary.mission = name;
    summary.final_soc_percent = soc;
    summary.depleted_at_s = depleted;
    summary.energy_wh = 10.0;
    summary.mechanical_energy_wh = 4.0;
    summary.compute_energy_wh = 6.0;
    summary.duration_s = 688.0;
    return summary;
}

TEST(Comparison, RanksByChargeThenByHowLongItLasts) {
    const auto ranking =
        ranked({outcome("fails", {}), outcome("early", 0.0, 100.0), outcome("little", 2.0), outcome("late", 0.0, 600.0),
                outcome("just", 0.0), outcome("much", 50.0), outcome("fails too", {})});
    std::vector<std::string> names;
    names.reserve(ranking.size());
    for (const auto& summary : ranking) names.push_back(summary.mission);
    EXPECT_EQ(names, (std::vector<std::string>{"much", "little", "just", "late", "early", "fails", "fails too"}));
}

TEST(Comparison, CutOffRanksBelowWhateverLasts) {
    auto cut_off = outcome("cut off", 40.0);
    cut_off.cut_off_at_s = 500.0;
    const auto ranking = ranked({outcome("early", 0.0, 100.0), cut_off, outcome("lasts", 2.0)});
    EXPECT_EQ(ranking[0].mission, "lasts");
    EXPECT_EQ(ranking[1].mission, "cut off");
}

TEST(Comparison, KeepsTheOrderOfEquals) {
    const auto ranking = ranked({outcome("b", 5.0), outcome("a", 5.0), outcome("c", 5.0)});
    EXPECT_EQ(ranking[0].mission, "b");
    EXPECT_EQ(ranking[1].mission, "a");
    EXPECT_EQ(ranking[2].mission, "c");
}

TEST(DescribePowerModel, SaysWhatIsUsedAndHowItPredicts) {
    EXPECT_EQ(describe(mechanical::HeldOutScore{"constant_mean", 4, 18.64}),
              "power by each phase's mean: 18.6 % off on 4 flights left out of the fit");
    EXPECT_EQ(describe(mechanical::HeldOutScore{"fourier", 4, 15.0}),
              "power by each phase's curve: 15.0 % off on 4 flights left out of the fit");
    EXPECT_EQ(
        describe(mechanical::HeldOutScore{"physical", 3, 2.7}),
        "cruise power by the physical model: 2.7 % off on 3 flights left out of the fit, their airspeed and climb "
        "known");
}

}  // namespace
}  // namespace flightwatt::mission

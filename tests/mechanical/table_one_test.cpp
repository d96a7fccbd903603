#include "mechanical/table_one.h"

#include "base/csv.h"
#include "base/number.h"
#include "helpers/made_up_flights.h"
#include "mechanical/mechanical_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using testing::ElementsAre;

TEST(TableOne, IsThePublishedTable) {
    const auto table = table_one(test::published_model());
    EXPECT_THAT(table.header, ElementsAre("coefficient", "take-off", "cruise", "landing", "unit"));
    ASSERT_EQ(table.rows.size(), 8U);
    EXPECT_THAT(table.rows[0], ElementsAre("a0", "29.97", "27.22", "27.21", "W"));
    EXPECT_THAT(table.rows[1], ElementsAre("a1", "1.57", "0.3737", "-0.9512", "W"));
    EXPECT_THAT(table.rows[2], ElementsAre("b1", "-1.963", "1.194", "1.276", "W"));
    EXPECT_THAT(table.rows[3], ElementsAre("a2", "0.3876", "0.6513", "0.9357", "W"));
    EXPECT_THAT(table.rows[4], ElementsAre("b2", "-1.552", "0.2954", "0.965", "W"));
    EXPECT_THAT(table.rows[5], ElementsAre("a3", "-0.2869", "0.5039", "0.4913", "W"));
    EXPECT_THAT(table.rows[6], ElementsAre("b3", "-0.547", "-0.2864", "-0.1192", "W"));
    EXPECT_THAT(table.rows[7], ElementsAre("xi", "0.1525", "0.1799", "0.1296", "rad"));
}

TEST(TableOne, IsTheTableInTheFileOfFacts) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto table = table_one(test::published_model());
    const auto facts = read_csv(test::shared_dir() / "paper" / "table1.csv");
    ASSERT_EQ(facts.rows.size(), table.rows.size());
    for (std::size_t i = 0; i < facts.rows.size(); ++i) {
        for (std::size_t j = 0; j < 4; ++j) EXPECT_EQ(facts.rows[i].cells[j].text, table.rows[i][j]);
    }
}

TEST(TableOne, LeavesRoomForPhasesOfOtherOrders) {
    auto model = test::published_model();
    model.phases[flight::Phase::cruise].fourier.cos_w.resize(1);
    model.phases[flight::Phase::cruise].fourier.sin_w.resize(1);
    const auto table = table_one(model);
    ASSERT_EQ(table.rows.size(), 8U);
    EXPECT_THAT(table.rows[2], ElementsAre("b1", "-1.963", "1.194", "1.276", "W"));
    EXPECT_THAT(table.rows[3], ElementsAre("a2", "0.3876", "-", "0.9357", "W"));
    EXPECT_EQ(table.rows[7][2], "0.1799");
    model.phases[flight::Phase::landing].fourier.cos_w.clear();
    model.phases[flight::Phase::landing].fourier.sin_w.clear();
    EXPECT_EQ(table_one(model).rows[7][3], "-");  // a constant has no frequency
}

TEST(TableOne, StandsBesideTheRegenerated) {
    const auto published = test::published_model();
    auto regenerated = published;
    auto& cruise = regenerated.phases[flight::Phase::cruise];
    cruise.fourier.a0_w *= 1.01;
    cruise.duration_s = 500.0;
    cruise.fourier.omega_rad_per_s *= 600.0 / 500.0;
    const auto table = table_one_comparison(published, regenerated);
    EXPECT_THAT(table.header,
                ElementsAre("coefficient", "take-off published", "take-off regenerated", "cruise published",
                            "cruise regenerated", "landing published", "landing regenerated", "unit"));
    ASSERT_EQ(table.rows.size(), 11U);
    EXPECT_THAT(table.rows[0], ElementsAre("a0", "29.97", "29.97", "27.22", "27.49", "27.21", "27.21", "W"));
    EXPECT_THAT(table.rows[7], ElementsAre("xi", "0.1525", "0.1525", "0.1799", "0.1799", "0.1296", "0.1296", "rad"));
    EXPECT_THAT(table.rows[8], ElementsAre("duration", "28", "28", "600", "500", "60", "60", "s"));
    EXPECT_EQ(table.rows[9][0], "curve RMS difference");
    EXPECT_EQ(table.rows[9][3], "-");
    EXPECT_EQ(table.rows[9][4], "0.2722");
    EXPECT_EQ(table.rows[9][2], "0");
    EXPECT_THAT(table.rows[10], ElementsAre("a0 difference", "-", "0", "-", "1", "-", "0", "%"));
    EXPECT_NE(to_text(table).find("cruise regenerated"), std::string::npos);
}

TEST(TableOne, IsLatexWithItsOwnLabelAndUnits) {
    const auto text = to_latex(table_one(test::published_model()), "tab:second");
    EXPECT_NE(text.find("\\label{tab:second}"), std::string::npos);
    EXPECT_NE(text.find("\n$a_{0}$ & $29.97$ & $27.22$ & $27.21$ & W \\\\\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\n$\\xi$ & $0.1525$ & $0.1799$ & $0.1296$ & rad \\\\\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace flightwatt::mechanical

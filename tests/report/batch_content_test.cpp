// What the report takes from a batch's folder.

#include "report/batch_content.h"

#include "helpers/running_program.h"
#include "helpers/test_paths.h"
#include "report/model_section.h"

#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

TEST(BatchContent, HoldsTheFlightsAndTheFitThatTheBatchStored) {
    const auto folder = test::scratch_dir();
    const auto logs = test::shell_quoted(test::source_dir() / "logs");
    const auto run = test::run_shell("echo nothing > broken.data; flightwatt batch " + logs +
                                         "/opterra_synthetic_0[1-3].data broken.data -o out "
                                         "--exclude opterra_synthetic_02",
                                     folder);
    ASSERT_EQ(run.code, 3) << run.err;
    const auto content = read_batch_content(folder / "out");
    ASSERT_EQ(content.flights.size(), 4U);
    ASSERT_TRUE(content.fit);
    EXPECT_EQ(content.measured.size(), 2U);
    for (const auto& flight : content.flights) {
        EXPECT_EQ(flight.rejected.empty(), flight.name != "broken") << flight.name;
        EXPECT_EQ(flight.exclusions.empty(), flight.name != "opterra_synthetic_02") << flight.name;
        EXPECT_EQ(flight.phases.sorties.size(), flight.name == "broken" ? 0U : 1U) << flight.name;
    }
    const auto model = model_of(*content.fit, std::nullopt);
    EXPECT_FALSE(model.bands[flight::Phase::cruise].time_s.empty());
    ASSERT_TRUE(model.table_one);
    EXPECT_EQ(model.table_one->header.size(), 7U) << "three phases, each with its intervals";
}

TEST(BatchContent, HasNoFitWhereTheBatchCouldNotFit) {
    const auto folder = test::scratch_dir();
    const auto run = test::run_shell("echo nothing > broken.data; flightwatt batch broken.data -o out", folder);
    EXPECT_NE(run.code, 0);
    const auto content = read_batch_content(folder / "out");
    EXPECT_FALSE(content.fit);
    EXPECT_TRUE(content.measured.empty());
}

TEST(FittedPart, FollowsExclusionsAndThePowerRecord) {
    ReportFlight flight;
    EXPECT_EQ(fitted_part(flight), "all");
    flight.exclusions = {"cruise is excluded: the log ends inside of it"};
    EXPECT_EQ(fitted_part(flight), "in part");
    flight.unusable_power = "its power does not change at all";
    EXPECT_EQ(fitted_part(flight), "no");
}

}  // namespace
}  // namespace flightwatt::report

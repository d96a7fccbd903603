// The README's five commands for one flight, of any kind: a model without variability, and no impossible power.

#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

TEST(SingleFlights, LeadFromTheBatchToTheReport) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const std::string log : {
             "autopilots/px4/wing_proto9.ulg",     // its take-off's curve falls below 0 W
             "autopilots/px4/copter_upgrade.ulg",  // and this one's landing's
             "wild/pb_1.BIN.gz",                   // eight, of which few have samples enough
         }) {
        SCOPED_TRACE(log);
        const auto folder = test::scratch_dir();
        const auto run = test::run_shell(
            "log=" + test::shell_quoted(test::shared_dir() / "archives" / log) +
                "; set -e; flightwatt batch \"$log\" -o my; flightwatt battery my --capacity 5 -o my/pack.toml\n"
                "flightwatt new-mission --model my/model.toml --battery my/pack.toml -o my/mission.toml\n"
                "flightwatt simulate my/mission.toml -o my/soc.csv\n"
                "flightwatt report my my/mission.toml -o my/report.html; grep -c '^power = \"mean\"' my/model.toml",
            folder);
        EXPECT_EQ(run.code, 0) << run.err;
        if (log != "wild/pb_1.BIN.gz") {
            EXPECT_THAT(run.out, testing::EndsWith("\n3\n")) << "one flight has no curve";
        }
    }
}

TEST(SingleFlights, OfACruiseOfOneSampleHaveNoModel) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto log = test::shared_dir() / "archives" / "wild" / "la_mechanical_fail.log";
    const auto run = test::run_shell("flightwatt batch " + test::shell_quoted(log) + " -o my", test::scratch_dir());
    EXPECT_EQ(run.code, 4);
    EXPECT_THAT(run.err,
                testing::HasSubstr("cruise is not used in the fit: it lasts 0.5 s, with 1 sample of the power"));
    EXPECT_THAT(run.err, testing::HasSubstr("add a log with a complete cruise"));
}

}  // namespace
}  // namespace flightwatt::cli

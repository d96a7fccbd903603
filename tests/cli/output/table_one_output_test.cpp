// Table I by the ending of its file.

#include "cli/output/table_one_output.h"

#include "base/error.h"
#include "helpers/made_up_flights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

const TextTable small{{"name", "a0"}, {{"cruise", "24.5"}}};

TEST(TableText, FollowsTheEndingOfTheFile) {
    EXPECT_EQ(table_text(small, "t.csv"), "name,a0\ncruise,24.5\n");
    EXPECT_EQ(table_text(small, "t.txt"), "name      a0\ncruise  24.5\n");
    EXPECT_THAT(table_text(small, "t.md"), HasSubstr("| cruise | 24.5 |"));
    EXPECT_THAT(table_text(small, "folder.csv/t.tex"), HasSubstr("\\begin{tabular}"));
}

TEST(TableText, RefusesAnotherEnding) {
    EXPECT_THROW(table_text(small, "t.pdf"), UsageError);
    EXPECT_THROW(table_text(small, "csv"), UsageError);
}

TEST(TableOf, StandsBesideAPublishedModelWhereThereIsOne) {
    const auto model = test::published_model();
    const auto alone = table_of(model, std::nullopt);
    const auto beside = table_of(model, model);
    EXPECT_EQ(alone.header.size(), 4U) << "a name and three phases";
    EXPECT_EQ(beside.header.size(), 7U);
    EXPECT_GT(beside.rows.size(), alone.rows.size()) << "durations and differences stand below";
}

}  // namespace
}  // namespace flightwatt::cli

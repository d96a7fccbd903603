#include "compute/powprofiler/powprofiler_csv.h"

#include "helpers/rejected.h"

#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

using test::rejected;

std::optional<PowprofilerColumns> columns(const std::string& header) {
    return powprofiler_columns(parse_csv(header + "\n", "p.csv", CsvHeader::absent));
}

TEST(PowprofilerCsv, BindsColumnsByFlag) {
    const auto found = columns("130,201,100,200,102,160");
    ASSERT_TRUE(found);
    EXPECT_EQ(found->power, 2U);
    EXPECT_EQ(found->parameters, (std::vector<std::size_t>{3, 1}));
}

TEST(PowprofilerCsv, ReadsJoinedFlags) {
    const auto found = columns("0+200,100+130,101");
    ASSERT_TRUE(found);
    EXPECT_EQ(found->power, 1U);
    EXPECT_EQ(found->parameters, std::vector<std::size_t>{0});
}

TEST(PowprofilerCsv, KnowsFlagsFromNumbersAndNames) {
    EXPECT_FALSE(columns("2,2,4.75376"));
    EXPECT_FALSE(columns("2,100,5"));  // 2 and 5 are no flags
    EXPECT_FALSE(columns("100.0,101"));
    EXPECT_FALSE(columns("fps,power_w"));
    EXPECT_FALSE(columns("100,"));
    EXPECT_FALSE(columns("100,103"));
    EXPECT_FALSE(columns("100,190"));
    EXPECT_FALSE(columns("100,300"));
    EXPECT_TRUE(columns("100,162"));
}

TEST(PowprofilerCsv, RefusesFlagsThatDoNotFit) {
    EXPECT_EQ(rejected([] { columns("200,101"); }), "p.csv:1: has no column of total power, flag 100");
    EXPECT_EQ(rejected([] { columns("200,100,200"); }), "p.csv:1:9: the flag 200 stands over two columns");
    EXPECT_EQ(rejected([] { columns("200,202,100"); }), "p.csv:1: has the parameter flag 202 without 201");
}

}  // namespace
}  // namespace flightwatt::compute

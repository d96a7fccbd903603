#include "report/figure.h"

#include "base/csv.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

TEST(FigureData, IsCsvThatReadsBackWhateverTheTexts) {
    FigureData data({"time_s", "power_w"}, {"flight"});
    data.add({1.5, -0.25}, {"a, \"b\"\n</script>"});
    data.add({2.0, std::nan("")}, {"αβγ"});
    const auto json = data.json();
    EXPECT_EQ(json["format"]["parse"]["power_w"], "number");
    EXPECT_FALSE(json["format"]["parse"].contains("flight"));
    EXPECT_EQ(json["values"], "time_s,power_w,flight\n1.5,-0.25,\"a, \"\"b\"\"\n</script>\"\n2,,αβγ");
}

TEST(FigureData, LeavesGapsForWhatIsNotFinite) {
    FigureData data({"x", "y"});
    EXPECT_TRUE(data.empty());
    data.add({1.0, std::numeric_limits<double>::infinity()});
    EXPECT_FALSE(data.empty());
    EXPECT_EQ(data.csv(), "x,y\n1,");
}

TEST(ScriptJson, CannotEndItsElement) {
    const VegaJson json{{"name", "</script><!--<script>"}};
    const auto text = script_json(json);
    EXPECT_EQ(text.find('<'), std::string::npos);
    EXPECT_EQ(VegaJson::parse(text), json);
}

TEST(ValidUtf8, ReplacesWhatIsNone) {
    EXPECT_EQ(valid_utf8("αβγ"), "αβγ");
    EXPECT_EQ(valid_utf8("a\xff"
                         "b"),
              "a\uFFFDb");
}

}  // namespace
}  // namespace flightwatt::report

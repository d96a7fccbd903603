#include "report/figure.h"

#include "base/csv.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

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

TEST(FigureData, RoundsToTheDecimalsOfItsColumns) {
    FigureData data({"time_s", "power_w"}, {"curve"});
    data.round_to({2, 1});
    data.add({1234.5678, -0.04}, {"measured"});
    data.add({0.1 + 0.2, 36.65000001}, {"measured"});
    data.add({std::nan(""), 1e20}, {"model"});
    EXPECT_EQ(data.csv(), "time_s,power_w,curve\n1234.57,0,measured\n0.3,36.7,measured\n,1e+20,model");
}

TEST(Filled, ReplacesFieldsAndLeavesOutLayersWithoutData) {
    const auto part = VegaJson::parse(R"({"title": "{{name}}", "step": 1, "more": "{{unknown}}",
                                          "layer": [{"data": "{{rows}}"}, {"data": "{{nothing}}"}, {"mark": "line"}]})");
    const VegaJson values{{"name", "{{rows}}"}, {"rows", {{"values", "a\n1"}}}, {"nothing", nullptr}};
    EXPECT_EQ(
        fill_template(part, values).dump(),
        R"({"title":"{{rows}}","step":1,"more":"{{unknown}}","layer":[{"data":{"values":"a\n1"}},{"mark":"line"}]})");
}

TEST(NewFigure, HasAPanelForEachOfTheValues) {
    const auto figure = new_figure("voltage", "v", "", "Of two flights.",
                                   {{"panels", {{{"curves", 1}, {"flight", "a"}}, {{"curves", 2}, {"flight", "b"}}}}});
    EXPECT_EQ(figure.spec["description"], "Of two flights.");
    ASSERT_EQ(figure.spec["concat"].size(), 2U);
    EXPECT_EQ(figure.spec["concat"][1]["layer"][0]["data"], 2);
    EXPECT_EQ(figure.spec.dump().find("{{"), std::string::npos);
}

TEST(ScriptJson, CannotEndItsElement) {
    const VegaJson json{{"name", "</script><!--<script>"}};
    const auto text = script_json(json);
    EXPECT_EQ(text.find('<'), std::string::npos);
    EXPECT_EQ(VegaJson::parse(text), json);
}

TEST(VisibleRows, AreAllOfAShortLine) {
    const std::vector<double> time_s{0.0, 1.0, 5.0};
    EXPECT_EQ(downsample_m4(time_s, {3.0, 1.0, 2.0}, 1), (std::vector<std::size_t>{0, 1, 2}));
}

/// Pixel columns look the same: each keeps its ends and extremes.
TEST(VisibleRows, KeepTheExtremesOfEveryColumn) {
    constexpr std::size_t columns = 10;
    std::vector<double> time_s;
    std::vector<double> values;
    for (int i = 0; i <= 1000; ++i) {
        time_s.push_back(i);
        values.push_back(std::sin(0.7 * i) * i);
    }
    const auto rows = downsample_m4(time_s, values, columns);
    EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
    EXPECT_LE(rows.size(), 4 * columns);
    EXPECT_EQ(rows.front(), 0U);
    EXPECT_EQ(rows.back(), 1000U);
    const std::set<std::size_t> kept(rows.begin(), rows.end());
    for (std::size_t column = 0; column < columns; ++column) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(100 * column);
        const auto greatest = std::max_element(begin, begin + 100) - values.begin();
        const auto least = std::min_element(begin, begin + 100) - values.begin();
        EXPECT_TRUE(kept.contains(static_cast<std::size_t>(greatest))) << column;
        EXPECT_TRUE(kept.contains(static_cast<std::size_t>(least))) << column;
    }
}

}  // namespace
}  // namespace flightwatt::report

#include "report/blocks/packed_tables.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

TEST(PackedTables, AreStepsInTheLastDecimalAndTexts) {
    FigureData data({"time_s", "power_w"}, {"curve"});
    data.add({8.0, 36.62}, {"measured, \"really\""});
    data.add({9.1, -0.5}, {"measured"});
    data.add({10.25, std::nan("")}, {""});
    data.add({11.0, 7.0}, {"model"});
    const VegaJson spec{{"layer", {{{"data", data.json()}, {"mark", "line"}}}}};
    const auto packed = VegaJson::parse(
        R"({"layer": [{"data": {"packed": [["time_s", 2, [800, 110, 115, 75]], ["power_w", 2, [3662, -3712, null, 750]],
                                           ["curve", ["measured, \"really\"", "measured", "", "model"]]]},
                       "mark": "line"}]})");
    EXPECT_EQ(packed_tables(spec), packed);
}

TEST(PackedTables, KeepNumbersThatNoStepsHold) {
    FigureData data({"tiny", "great", "wide"});
    data.add({1.5e-9, 2e12, 1.0});
    data.add({0.25, 3.0, std::nan("")});
    const auto packed = packed_tables(data.json());
    EXPECT_EQ(packed, VegaJson::parse(R"({"packed": [["tiny", [1.5e-9, 0.25]], ["great", [2e12, 3.0]],
                                                     ["wide", 0, [1, null]]]})"));
}

TEST(PackedTables, KeepWhatHasMoreDigitsThanADouble) {
    const VegaJson csv{{"values", "sum,long\n123456789012.5,1234567890123456\n0.12345,1\n"},
                       {"format", {{"type", "csv"}, {"parse", {{"sum", "number"}, {"long", "number"}}}}}};
    EXPECT_EQ(packed_tables(csv), VegaJson::parse(R"({"packed": [["sum", [123456789012.5, 0.12345]],
                                                                 ["long", [1234567890123456.0, 1.0]]]})"));
}

TEST(PackedTables, LeaveEverythingElse) {
    const auto spec = vega(R"({"data": {"values": [{"a": 1}]}, "datasets": {"edges": "a,b\n1,2"},
                               "other": {"values": "a,b\n1,2", "format": {"type": "tsv"}}, "list": [1, null, "text"]})");
    EXPECT_EQ(packed_tables(spec), spec);
}

TEST(PackedTables, OfATableWithoutRowsHaveItsColumns) {
    EXPECT_EQ(packed_tables(FigureData({"x"}, {"word"}).json()),
              VegaJson::parse(R"({"packed": [["x", 0, []], ["word", []]]})"));
}

}  // namespace
}  // namespace flightwatt::report

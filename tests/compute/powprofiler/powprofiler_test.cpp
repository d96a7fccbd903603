#include "compute/powprofiler/powprofiler.h"

#include "base/statistics.h"
#include "helpers/rejected.h"

#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

using test::rejected;
using test::scratch_dir;
using test::write_text;

TEST(PowprofilerConfig, ReadsCombinations) {
    const auto folder = scratch_dir();
    for (const auto* name : {"1,5=a.csv", "b.csv"}) write_text(folder / name, "");
    const auto config =
        read_powprofiler_config(write_text(folder / "c.cfg",
                                           "  [settings]  # ours\n frequency = 20\nh=0,01\ndirectory=out\n\n"
                                           "\t[combinations]\r\n# none\n1,5=a.csv=4,0.5 # yes\nb.csv = 1 , 10\n"
                                           "name=out.csv\n[components]\n[component.a]\nsrc=./a\nrange=1,4,pow(2)"));
    ASSERT_EQ(config.size(), 2U);
    EXPECT_EQ(config[0].recording, folder / "1,5=a.csv");
    EXPECT_EQ(config[0].qos, (std::vector<double>{4.0, 0.5}));
    EXPECT_EQ(config[1].recording, folder / "b.csv");
    EXPECT_EQ(config[1].qos, (std::vector<double>{1.0, 10.0}));
    EXPECT_EQ(config[1].where.line, 9U);
}

TEST(PowprofilerConfig, RefusesWhatIsNoCombination) {
    const auto folder = scratch_dir();
    const auto of = [&](const std::string& text) {
        return rejected([&] { read_powprofiler_config(write_text(folder / "c.cfg", text)); }, folder);
    };
    EXPECT_EQ(of("[combinations]\na.csv\n"), "c.cfg:2: 'a.csv' is neither [section] nor name=value");
    EXPECT_EQ(of("[combinations]\na.csv=1,x\n"),
              "c.cfg:2: 'x' is not a finite number; write decimals with a point, values apart with a comma");
    EXPECT_EQ(of("[combinations]\na.csv=1,2\nb.csv=1\n"), "c.cfg:3: 1 values, expected 2 as in line 2");
    EXPECT_EQ(of("a.csv=1,2\n"), "c.cfg:1: 'a.csv=1,2' is outside of [settings] and [combinations]");
    EXPECT_EQ(of("[component.a]\nsrc=b\n"),
              "c.cfg: has no [combinations], lines of file.csv=value,value; write what powprofiler runs by "
              "[components] as TOML, [components.NAME]");
}

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
    EXPECT_EQ(rejected([] { columns("200,100,200"); }), "p.csv:1:9: the flag 200 heads two columns");
    EXPECT_EQ(rejected([] { columns("200,202,100"); }), "p.csv:1: has the parameter flag 202 without 201");
}

std::vector<double> recording(const std::string& text) {
    return layer1_power_w(parse_csv(text, "r.csv", CsvHeader::absent));
}

TEST(PowerRecording, FindsTotalPowerByItsFlag) {
    EXPECT_EQ(recording("100,101,102\n4,1,2\n5,1,2\n6,1,2\n9,1,2"), (std::vector{4.0, 5.0, 6.0, 9.0}));
    EXPECT_EQ(recording("101,102,100+0\n1,2,7\n"), std::vector{7.0});
}

TEST(PowerRecording, RefusesWhatIsNoLayerOne) {
    EXPECT_EQ(rejected([] { recording("power_w\n1\n"); }),
              "r.csv:1: is no powprofiler layer 1, whose first row is 100,101,102");
    EXPECT_EQ(rejected([] { recording("200,100\n1,2\n"); }),
              "r.csv:1: is no powprofiler layer 1, whose first row is 100,101,102; flags from 200 are QoS "
              "parameters: "
              "this is a layer 2");
    EXPECT_EQ(rejected([] { recording("100,101\n"); }), "r.csv:1: has a header and no samples");
    EXPECT_EQ(rejected([] { recording("100,101\n1,2\nnan,2\n"); }),
              "r.csv:3:1: column 1 is not a finite number: 'nan'");
}

TEST(PowerRecording, ReadsTheRealRecordings) {
    FLIGHTWATT_NEEDS_SHARED();
    struct Real {
        const char* name;
        std::size_t samples;
        double mean_w;  ///< as the layer 2 made from the recordings has it
    };
    const Real reals[] = {{"1_Yolo4fps_nfold10fps", 1032, 6.22922},   {"2_Yolo4fps_nfold0,5fps", 1015, 6.30497},
                          {"3_Yolo1fps_nfold10fps", 996, 4.99916},    {"4_Yolo1fps_nfold0,5fps", 981, 4.81432},
                          {"5_Yolo0,25fps_nfold10fps", 971, 4.35776}, {"6_Yolo0,25fps_nfold0,5fps", 970, 4.10743},
                          {"7_Yolo0,1fps_nfold10fps", 955, 4.01517},  {"8_Yolo0,1fps_nfold0,5fps", 982, 3.93941}};
    for (const auto& real : reals) {
        const auto file = test::shared_dir() / "powprofiler" / ("tracking_" + std::string(real.name) + ".csv");
        const auto power_w = layer1_power_w(read_csv(file, CsvHeader::absent));
        EXPECT_EQ(power_w.size(), real.samples) << real.name;
        EXPECT_NEAR(mean(power_w), real.mean_w, 5e-6) << real.name;
    }
}

}  // namespace
}  // namespace flightwatt::compute

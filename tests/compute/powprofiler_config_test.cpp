#include "compute/powprofiler_config.h"

#include "rejected.h"

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

using test::rejected;
using test::scratch_dir;
using test::write_text;

TEST(PowprofilerConfig, ReadsCombinations) {
    const auto folder = scratch_dir();
    const auto config = read_powprofiler_config(
        write_text(folder / "c.cfg",
                   "  [settings]  # ours\n frequency = 20\nh=0,01\ndirectory=out\n\n"
                   "\t[combinations]\r\n# none\n1,5=a.csv=4,0.5 # yes\nb.csv = 1 , 10\n"
                   "name=out.csv"));
    EXPECT_EQ(config.sampling_hz, 20.0);
    ASSERT_EQ(config.combinations.size(), 2U);
    EXPECT_EQ(config.combinations[0].recording, folder / "1,5=a.csv");
    EXPECT_EQ(config.combinations[0].qos, (std::vector<double>{4.0, 0.5}));
    EXPECT_EQ(config.combinations[1].recording, folder / "b.csv");
    EXPECT_EQ(config.combinations[1].qos, (std::vector<double>{1.0, 10.0}));
    EXPECT_EQ(config.combinations[1].where.line, 9U);
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
    EXPECT_EQ(of("a.csv=1,2\n"), "c.cfg:1: 'a.csv=1,2' stands before any [section]");
    EXPECT_EQ(of("[settings]\nfrequency=-1\n"), "c.cfg:2: frequency = -1 Hz is not positive");
    EXPECT_EQ(of("[settings]\nfrequencie=1\n"),
              "c.cfg:2: unknown setting 'frequencie'; known are frequency, h and directory");
    EXPECT_EQ(of("[settings]\n[components]\n[component.yolo]\nsrc=/usr/bin/yolo\nrange=1,4,1\n"),
              "c.cfg: has no [combinations], lines of file.csv=value,value; [components] say how to profile, "
              "not what "
              "came out");
}

}  // namespace
}  // namespace flightwatt

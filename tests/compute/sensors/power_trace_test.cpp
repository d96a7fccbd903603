#include "compute/sensors/power_trace.h"

#include "helpers/rejected.h"

#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

using test::rejected;
using Values = std::vector<double>;

class Recording : public testing::Test {
  protected:
    std::filesystem::path folder = test::scratch_dir();

    PowerTrace read(const std::string& text, std::optional<double> interval_s = {}) const {
        return read_power_trace(test::write_text(folder / "r", text), interval_s);
    }
    std::string refused(const std::string& text) const {
        return rejected([&] { read(text); }, folder);
    }
};

TEST_F(Recording, Csv) {
    const auto trace = read("# meter\nvoltage_v,time_s,power_w\n5,0,1.5\n5,0.25,2\n");
    EXPECT_EQ(trace.time_s, (Values{0.0, 0.25}));
    EXPECT_EQ(trace.power_w, (Values{1.5, 2.0}));
    EXPECT_EQ(refused("time_s,power_w\n1,2\n1,3\n"), "r:3: time_s = 1 follows 1; sort the recording by time");
    EXPECT_EQ(refused("time_s,power_w\n"), "r: has a header and no samples");
    EXPECT_EQ(refused("time_s,power_mw\n1,2\n"), "r:1: has no column 'power_w'; its columns are time_s, power_mw");
    EXPECT_EQ(refused("a,b\n1,2\n"),
              "r:1: is not a recording of power: neither time_s,power_w nor 100,... nor tegrastats");
}

TEST_F(Recording, TegrastatsOfOrin) {
    const std::string lines =
        "11-21-2022 13:41:59 RAM 2448/7850MB (lfb 3x4MB) SWAP 0/3925MB (cached 0MB) CPU [1%@729,off] "
        "EMC_FREQ 0%@2133 GR3D_FREQ 0%@[305] cpu@47.5C VDD_IN 4936mW/4936mW VDD_CPU_GPU_CV 524mW/524mW "
        "VDD_SOC 1417mW/1417mW\n"
        "11-21-2022 13:42:01 RAM 2448/7850MB (lfb 3x4MB) VDD_IN 5054mW/4995mW VDD_CPU_GPU_CV 564mW/544mW\n";
    EXPECT_EQ(read(lines).time_s, (Values{0.0, 2.0}));
    EXPECT_EQ(read(lines).power_w, (Values{4.936, 5.054}));
    EXPECT_EQ(read(lines, 0.5).time_s, (Values{0.0, 0.5}));
    EXPECT_EQ(refused("11-21-2022 13:41:59 VDD_IN 1mW/1mW\n11-21-2022 13:41:59 VDD_IN 1mW/1mW\n"),
              "r:2: date is not after that of the previous line; dates count whole seconds: give the sampler's "
              "interval_s");
}

TEST_F(Recording, TegrastatsOfNanoAndXavier) {
    const std::string nano =
        "RAM 1033/3964MB (lfb 499x4MB) IRAM 0/252kB(lfb 252kB) CPU [12%@518,8%@518] PLL@31.5C "
        "POM_5V_IN 2545/2600 POM_5V_GPU 82/82 POM_5V_CPU 493/520\n";
    EXPECT_EQ(read(nano + nano, 1.0).power_w, (Values{2.545, 2.545}));
    EXPECT_EQ(refused(nano),
              "r:1: has no date and no interval is given; give the sampler's interval_s, tegrastats "
              "--interval");
    const std::string xavier =
        "RAM 9/15692MB CPU [2%@1190] GPU 620/620 CPU 465/465 SOC 931/931 CV 0/0 VDDRQ 310/310 "
        "SYS5V 1481/1481\n";
    EXPECT_DOUBLE_EQ(read(xavier, 1.0).power_w.front(), 3.807);
    EXPECT_EQ(rejected([&] { read(nano + "Segmentation fault\n", 1.0); }, folder),
              "r:2: has no rail with its power, 'VDD_IN 4936mW/4936mW'; keep complete lines of tegrastats");
}

TEST_F(Recording, PowprofilerLayerOne) {
    const auto trace = read("100,101,102\n4,1,1\n5,1,1\n", 0.1);
    EXPECT_EQ(trace.time_s, (Values{0.0, 0.1}));
    EXPECT_EQ(trace.power_w, (Values{4.0, 5.0}));
    EXPECT_EQ(refused("100\n4\n"), "r: has no time stamps; give the sampler's interval_s");
}

}  // namespace
}  // namespace flightwatt::compute

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
    EXPECT_EQ(refused("a,b\n1,2\n"), "r:1: is not a recording of power: neither time_s,power_w nor 100,...");
}

TEST_F(Recording, PowprofilerLayerOne) {
    const auto trace = read("100,101,102\n4,1,1\n5,1,1\n", 0.1);
    EXPECT_EQ(trace.time_s, (Values{0.0, 0.1}));
    EXPECT_EQ(trace.power_w, (Values{4.0, 5.0}));
    EXPECT_EQ(refused("100\n4\n"), "r: has no time stamps; give the sampler's interval_s");
}

}  // namespace
}  // namespace flightwatt::compute

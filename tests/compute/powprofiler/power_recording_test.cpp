#include "compute/powprofiler/power_recording.h"

#include "helpers/rejected.h"

#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

using test::rejected;

PowerRecording recording(const std::string& text, double sampling_hz = powprofiler_sampling_hz) {
    return power_recording_from(parse_csv(text, "r.csv", CsvHeader::absent), sampling_hz);
}

TEST(PowerRecording, HasMeanDurationAndEnergy) {
    const auto r = recording("100,101,102\n4,1,2\n5,1,2\n6,1,2\n9,1,2", 2.0);
    EXPECT_EQ(r.power_w, (std::vector<double>{4.0, 5.0, 6.0, 9.0}));
    EXPECT_EQ(mean_power_w(r), 6.0);
    EXPECT_EQ(duration_s(r), 2.0);
    EXPECT_EQ(energy_j(r), 12.0);
}

TEST(PowerRecording, FindsTotalPowerByItsFlag) {
    EXPECT_EQ(recording("101,102,100+0\n1,2,7\n").power_w, std::vector<double>{7.0});
}

TEST(PowerRecording, IsSampledAtTenHertzUnlessTold) {
    EXPECT_EQ(duration_s(recording("100\n1\n1\n1\n1\n1\n")), 0.5);
    EXPECT_EQ(rejected([] { recording("100\n1\n", 0.0); }),
              "r.csv: cannot be sampled at 0 Hz, expected more than 0");
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
    const Real reals[] = {
        {"1_Yolo4fps_nfold10fps", 1032, 6.22922},   {"2_Yolo4fps_nfold0,5fps", 1015, 6.30497},
        {"3_Yolo1fps_nfold10fps", 996, 4.99916},    {"4_Yolo1fps_nfold0,5fps", 981, 4.81432},
        {"5_Yolo0,25fps_nfold10fps", 971, 4.35776}, {"6_Yolo0,25fps_nfold0,5fps", 970, 4.10743},
        {"7_Yolo0,1fps_nfold10fps", 955, 4.01517},  {"8_Yolo0,1fps_nfold0,5fps", 982, 3.93941}};
    for (const auto& real : reals) {
        const auto file =
            test::shared_dir() / "powprofiler" / ("tracking_" + std::string(real.name) + ".csv");
        const auto r = read_power_recording(file);
        EXPECT_EQ(r.power_w.size(), real.samples) << real.name;
        EXPECT_NEAR(mean_power_w(r), real.mean_w, 5e-6) << real.name;
        double sum_w = 0.0;
        for (const double power : r.power_w) sum_w += power;
        EXPECT_EQ(energy_j(r), mean_power_w(r) * duration_s(r)) << real.name;
        EXPECT_NEAR(energy_j(r), sum_w / 10.0, 1e-9) << real.name;
    }
}

}  // namespace
}  // namespace flightwatt::compute

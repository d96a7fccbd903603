#include "compute/compute_model.h"

#include "compute/profile_reader.h"
#include "helpers/test_paths.h"

#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

ComputeModel paper_model() {
    const auto fits = test::source_dir() / "fits" / "compute";
    return {{{"detection", read_power_profile(fits / "tx2-detection.csv")},
             {"encryption", read_power_profile(fits / "tx2-encryption.csv")}}};
}

TEST(ComputeModel, ComponentsAdd) {
    const auto model = paper_model();
    for (const double fps : {5.8, 7.0, 10.0, 30.0, 32.0}) {
        for (const double key_bits : {32.0, 100.0, 448.0}) {
            const double together = power_w(model, {{0, {fps}}, {1, {key_bits}}});
            EXPECT_DOUBLE_EQ(together, power_w(model, {{0, {fps}}}) + power_w(model, {{1, {key_bits}}}));
        }
    }
}

TEST(ComputeModel, DrawsNothingWhenNothingRuns) { EXPECT_EQ(power_w(paper_model(), {}), 0.0); }

TEST(ComputeModel, HoldsThePaperProfile) {
    // The three configurations of Fig. 3, in watts as Fig. 4 gives them.
    const auto model = paper_model();
    EXPECT_NEAR(power_w(model, {{0, {5.8}}, {1, {32.0}}}), 22.40, 0.005);
    EXPECT_NEAR(power_w(model, {{0, {10.0}}, {1, {240.0}}}), 24.28 + 3.11, 0.005);
    EXPECT_NEAR(power_w(model, {{0, {32.0}}, {1, {448.0}}}), 35.08 + 5.16, 0.005);
    EXPECT_NEAR(power_w(model, {{0, {25.0}}, {1, {136.0}}}), 31.01 + 1.69, 0.005);
    EXPECT_NEAR(power_w(model, {{1, {344.0}}}), 4.87, 0.005);
    EXPECT_EQ(model.components[0].profile.parameters, std::vector<std::string>{"fps"});
    EXPECT_EQ(model.components[1].profile.parameters, std::vector<std::string>{"key_bits"});
}

}  // namespace
}  // namespace flightwatt::compute

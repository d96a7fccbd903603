#include "compute/compute_model.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

using Values = std::vector<double>;

TEST(EvenlySpaced, EndsAtTheLastWholeStep) {
    EXPECT_EQ(linear_range(1.0, 4.0, 1.0), (Values{1, 2, 3, 4}));
    EXPECT_EQ(linear_range(1.0, 4.9, 1.5), (Values{1, 2.5, 4}));
    EXPECT_EQ(linear_range(2.0, 2.0, 1.0), Values{2});
}

TEST(EvenlySpaced, IsSpelledWithoutRoundingErrors) {
    EXPECT_EQ(linear_range(0.1, 0.3, 0.1), (Values{0.1, 0.2, 0.3}));
    EXPECT_EQ(linear_range(0.0, 1.0, 0.1).size(), 11U);
}

TEST(CombinationsOf, RunTheLastParameterFastest) {
    EXPECT_EQ(cartesian_product({{"fps", {5, 10}}, {"bits", {32, 64, 128}}}),
              (std::vector<Values>{{5, 32}, {5, 64}, {5, 128}, {10, 32}, {10, 64}, {10, 128}}));
    EXPECT_EQ(cartesian_product({}), std::vector<Values>{{}});
}

TEST(WithQos, ReplacesTheParametersAlone) {
    const std::vector<std::string> parameters{"fps", "key_bits"};
    EXPECT_EQ(format_qos(parameters, {5.8, 32.0}), "fps=5.8 key_bits=32");
    EXPECT_EQ(format_qos(parameters, {5.8, 32.0}, " = ", ", "), "fps = 5.8, key_bits = 32");
    EXPECT_EQ(format_qos({}, {}), "");
    EXPECT_EQ(substitute_qos("run-{fps} {key_bits} {fps}", parameters, {5.8, 32.0}), "run-5.8 32 5.8");
    EXPECT_EQ(substitute_qos("awk '{print $1}' {fsp}", parameters, {5.8, 32.0}), "awk '{print $1}' {fsp}");
}

}  // namespace
}  // namespace flightwatt::compute

// Options of several stages: of a fit, and of drawn flights.

#include "cli/output/stage_options.h"

#include "base/error.h"
#include "helpers/given_options.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

FitArguments fit_arguments(const std::vector<std::string>& words) {
    FitArguments arguments;
    Options options;
    add_model_options(options, arguments);
    test::give_options(options, words);
    return arguments;
}

SamplingArguments sampling_arguments(const std::vector<std::string>& words) {
    SamplingArguments arguments;
    Options options;
    add_sampling_options(options, arguments);
    test::give_options(options, words);
    return arguments;
}

TEST(FitOptions, AreTheLibrarysUnlessGiven) {
    const mechanical::ModelFitOptions usual;
    const auto arguments = fit_arguments({});
    EXPECT_EQ(arguments.fit.phases.order, usual.phases.order);
    EXPECT_EQ(arguments.fit.weighting, usual.weighting);
    EXPECT_EQ(arguments.kind, ModelKind::best);
    const auto other = fit_arguments({"--order", "5", "--weights", "uniform", "--model-kind", "best"});
    EXPECT_EQ(other.fit.phases.order, 5);
    EXPECT_EQ(other.fit.weighting, mechanical::Weighting::uniform);
    EXPECT_EQ(other.kind, ModelKind::best);
}

TEST(FitOptions, RefuseOtherOrdersAndWeights) {
    for (const auto* text : {"auto", "9", "-1"})
        EXPECT_THROW(fit_arguments({std::string("--order=") + text}), UsageError) << text;
    EXPECT_THROW(fit_arguments({"--weights", "heavy"}), UsageError);
}

TEST(SamplingOptions, AreNoneWithoutSamples) {
    EXPECT_FALSE(sampling_options(sampling_arguments({}), false));
    EXPECT_THROW(sampling_arguments({"--seed", "3"}), UsageError) << "it belongs to --samples";
}

TEST(SamplingOptions, HaveNumberSeedAndBands) {
    const auto options = sampling_options(sampling_arguments({"--samples", "500", "--seed", "3"}), true);
    ASSERT_TRUE(options);
    EXPECT_EQ(options->samples, 500U);
    EXPECT_EQ(options->seed, 3U);
    EXPECT_GT(options->band_points, 0U);
    EXPECT_EQ(sampling_options(sampling_arguments({"--samples", "500"}), false)->seed, 1U);
}

}  // namespace
}  // namespace flightwatt::cli

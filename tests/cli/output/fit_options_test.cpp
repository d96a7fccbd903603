// The options of a fit.

#include "cli/output/fit_options.h"

#include "base/error.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

StageCall call_with(const std::vector<std::string>& arguments) {
    namespace po = boost::program_options;
    po::options_description options;
    add_fit_options(options, AutoOrder::accepted);
    StageCall call;
    call.program = "flightwatt-fit";
    po::store(po::command_line_parser(arguments).options(options).run(), call.options);
    return call;
}

std::string refusal(const std::vector<std::string>& arguments, AutoOrder automatic = AutoOrder::refused) {
    try {
        read_fit_options(call_with(arguments), automatic);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "nothing refused";
}

TEST(FitOptions, AreTheLibrarysUnlessGiven) {
    const mechanical::ModelFitOptions usual;
    const auto options = read_fit_options(call_with({}));
    EXPECT_EQ(options.phases.order, usual.phases.order);
    EXPECT_EQ(options.weights.weighting, usual.weights.weighting);
    EXPECT_NEAR(options.phases.min_theta_rad, usual.phases.min_theta_rad, 1e-12);
    EXPECT_EQ(options.phases.max_periods, usual.phases.max_periods);
    EXPECT_EQ(read_fit_options(call_with({"--order", "5"})).phases.order, 5);
}

TEST(FitOptions, ChooseTheOrderOnlyWhereTheStageCan) {
    EXPECT_EQ(read_order(call_with({"--order", "auto"}), AutoOrder::accepted), std::nullopt);
    EXPECT_THAT(refusal({"--order", "auto"}), HasSubstr("'flightwatt fit' can choose it"));
    EXPECT_THAT(refusal({"--order", "9"}), HasSubstr("--order 9: expected 0 to 8"));
    EXPECT_THAT(refusal({"--order=-1"}), HasSubstr("expected 0 to 8"));
}

TEST(FitOptions, TakeWeightsByHandForAFlightOrItsPhase) {
    const auto options = read_fit_options(call_with({"--weight", "a=0.4", "--weight", "b:c:cruise=2"}));
    EXPECT_EQ(options.weights.weighting, mechanical::Weighting::manual);
    ASSERT_EQ(options.weights.by_hand.size(), 2U);
    EXPECT_EQ(options.weights.by_hand[0].flight, "a");
    EXPECT_EQ(options.weights.by_hand[0].phase, std::nullopt);
    EXPECT_EQ(options.weights.by_hand[0].weight, 0.4);
    EXPECT_EQ(options.weights.by_hand[1].flight, "b:c");
    EXPECT_EQ(options.weights.by_hand[1].phase, flight::Phase::cruise);
}

TEST(FitOptions, RefuseWhatDoesNotFitTogether) {
    EXPECT_THAT(refusal({"--weight", "a"}), HasSubstr("expected FLIGHT=NUMBER"));
    EXPECT_THAT(refusal({"--weight", "a:glide=1"}), HasSubstr("no phase 'glide'"));
    EXPECT_THAT(refusal({"--weight", "a=1", "--weights", "uniform"}), HasSubstr("exclude each other"));
    EXPECT_THAT(refusal({"--weights", "heavy"}), HasSubstr("expected uniform, inverse-variance or agreement"));
    EXPECT_NE(refusal({"--min-periods", "-1"}), "nothing refused");
}

}  // namespace
}  // namespace flightwatt::cli

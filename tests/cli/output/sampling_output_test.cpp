// The options of drawing flights.

#include "cli/output/sampling_output.h"

#include "base/error.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

StageCall call_with(const std::vector<std::string>& arguments) {
    StageDefinition stage;
    add_sampling_options(stage);
    StageCall call;
    namespace po = boost::program_options;
    po::store(po::command_line_parser(arguments).options(stage.options).run(), call.options);
    return call;
}

TEST(SamplingOptions, AreNoneWithoutSamples) {
    EXPECT_FALSE(sampling_options(call_with({}), false));
    EXPECT_THROW(sampling_options(call_with({"--seed", "3"}), false), UsageError)
        << "it belongs to --samples";
}

TEST(SamplingOptions, HoldNumberSeedAndBands) {
    const auto options = sampling_options(call_with({"--samples", "500", "--seed", "3"}), true);
    ASSERT_TRUE(options);
    EXPECT_EQ(options->samples, 500U);
    EXPECT_EQ(options->seed, 3U);
    EXPECT_GT(options->band_times, 0U);
    EXPECT_EQ(sampling_options(call_with({"--samples", "500"}), false)->seed, 1U);
}

TEST(SamplingOptions, RefuseWhatIsNoWholeNumber) {
    for (const auto* text : {"-5", "1.5", "many"}) {
        EXPECT_THROW(sampling_options(call_with({std::string("--samples=") + text}), false), UsageError)
            << text;
    }
}

}  // namespace
}  // namespace flightwatt::cli

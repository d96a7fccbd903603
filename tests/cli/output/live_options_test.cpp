// What predict and watch predict from, as options state it.

#include "cli/output/live_options.h"

#include "base/error.h"
#include "helpers/given_options.h"
#include "helpers/test_paths.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

std::string path_of(const char* below_source) { return (test::source_dir() / below_source).string(); }

BasisArguments arguments_of(const std::vector<std::string>& words, bool with_battery) {
    BasisArguments arguments;
    arguments.uses_missions_battery = with_battery;
    Options options;
    add_basis_options(options, arguments);
    test::give_options(options, words);
    return arguments;
}

live::PredictionInput basis_of(const std::vector<std::string>& words, bool with_battery,
                               std::optional<mission::MissionVariant>* mission = nullptr) {
    StageCall call;
    call.program = "test";
    return read_basis(call, arguments_of(words, with_battery), mission);
}

TEST(BasisOptions, OfAMissionWithoutAPathTakeItsCruiseAndItsBattery) {
    const std::vector<std::string> words{"--mission", path_of("missions/synthetic/thevenin-plan.toml")};
    std::optional<mission::MissionVariant> mission;
    const auto basis = basis_of(words, true, &mission);
    ASSERT_TRUE(mission);
    EXPECT_EQ(basis.cruise_s, 1800.0);
    EXPECT_EQ(basis.limits.reserve_soc_percent, 20.0);
    EXPECT_TRUE(basis.battery && basis.battery->thevenin);
    EXPECT_FALSE(basis.initial_soc_percent) << "its voltage shows it";
    EXPECT_FALSE(basis.no_prediction_reason.empty()) << "a published model has no spread";
    EXPECT_THROW(basis_of(words, false), InputError) << "which predict cannot do without";
}

TEST(BasisOptions, ThatAreGivenCountBeforeTheMissions) {
    const std::vector<std::string> words{"--mission",     path_of("missions/synthetic/survey-path.toml"),
                                         "--battery",     path_of("fits/battery/paper.toml"),
                                         "--remaining",   "60",
                                         "--initial-soc", "77"};
    const auto basis = basis_of(words, true);
    EXPECT_FALSE(basis.battery->thevenin);
    EXPECT_EQ(basis.initial_soc_percent, 77.0);
    EXPECT_EQ(basis.remaining_s, 60.0);
    EXPECT_TRUE(basis.path);
    EXPECT_TRUE(basis.no_prediction_reason.empty());
}

TEST(BasisOptions, RefuseWhatDoesNotFitTogether) {
    const auto model = path_of("fits/mechanical/synthetic-wing.toml");
    const std::vector<std::vector<std::string>> refused{{},
                                                        {"--model", model},
                                                        {"--model", model, "--remaining", "10", "--climb", "1"},
                                                        {"--model", model, "--remaining", "10", "--initial-soc", "50"}};
    for (const auto& words : refused) EXPECT_THROW(basis_of(words, true), UsageError);
}

}  // namespace
}  // namespace flightwatt::cli

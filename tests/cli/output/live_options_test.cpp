// What predict and watch predict from, as options say it.

#include "cli/output/live_options.h"

#include "base/error.h"
#include "helpers/test_paths.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

namespace po = boost::program_options;

std::string path_of(const char* below_source) { return (test::source_dir() / below_source).string(); }

StageCall call_of(const std::vector<std::string>& words, PathNeed need) {
    po::options_description options;
    options.add_options()("model", value("FILE"), "");
    add_basis_options(options, need);
    StageCall call;
    call.program = "test";
    po::store(po::command_line_parser(words).options(options).run(), call.options);
    po::notify(call.options);
    return call;
}

TEST(BasisOptions, OfAMissionWithoutAPathTakeItsCruiseAndItsBattery) {
    const auto call = call_of({"--mission", path_of("missions/synthetic/thevenin-plan.toml")}, PathNeed::optional);
    std::optional<mission::MissionVariant> mission;
    const auto basis = read_basis(call, PathNeed::optional, &mission);
    ASSERT_TRUE(mission);
    EXPECT_EQ(basis.cruise_s, 1800.0);
    EXPECT_EQ(basis.limits.reserve_soc_percent, 20.0);
    EXPECT_TRUE(basis.battery && basis.battery->thevenin);
    EXPECT_FALSE(basis.initial_soc_percent) << "its voltage tells it";
    EXPECT_FALSE(basis.no_prediction_reason.empty()) << "a published model has no spread";
    EXPECT_THROW(
        read_basis(call_of({"--mission", path_of("missions/synthetic/thevenin-plan.toml")}, PathNeed::required),
                   PathNeed::required),
        InputError);
}

TEST(BasisOptions, ThatAreGivenCountBeforeTheMissions) {
    const std::vector<std::string> words{"--mission",     path_of("missions/synthetic/survey-path.toml"),
                                         "--battery",     path_of("fits/battery/paper.toml"),
                                         "--remaining",   "60",
                                         "--initial-soc", "77"};
    const auto basis = read_basis(call_of(words, PathNeed::optional), PathNeed::optional);
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
    for (const auto& words : refused)
        EXPECT_THROW(read_basis(call_of(words, PathNeed::optional), PathNeed::optional), UsageError);
}

}  // namespace
}  // namespace flightwatt::cli

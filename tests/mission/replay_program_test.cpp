// flightwatt replay on the real flights.

#include "helpers/running_program.h"
#include "helpers/test_paths.h"

#include <filesystem>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt::mission {
namespace {

TEST(ReplayProgram, JudgesSchedulesOnRealFlights) {
    const auto flights = test::shared_dir() / "flights";
    std::string arguments;
    for (const auto* name : {"20_07_03__12_17_45", "20_07_05__10_26_44", "20_07_10__06_53_03"}) {
        const auto log = flights / (std::string(name) + ".data");
        if (!std::filesystem::exists(log)) GTEST_SKIP() << "../shared/flights is not here";
        arguments += " " + test::shell_quoted(log);
    }
    const auto mission = test::source_dir() / "missions" / "paper" / "adaptive-replanned.toml";
    const auto run =
        test::run_shell("flightwatt replay" + arguments + " --order 1 --json --mission " + test::shell_quoted(mission),
                        test::binary_dir());
    ASSERT_EQ(run.code, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    ASSERT_EQ(json["replays"].size(), 3U);
    for (const auto& replay : json["replays"]) {
        SCOPED_TRACE(replay["flight"].get<std::string>());
        EXPECT_EQ(replay["training_overlap"], "no");
        EXPECT_EQ(replay["model_flights"].size(), 2U);
        EXPECT_NEAR(replay["measured_mechanical_wh"].get<double>(), replay["counter_energy_wh"].get<double>(),
                    0.005 * replay["counter_energy_wh"].get<double>());
        std::map<std::string, nlohmann::json> by_method;
        for (const auto& schedule : replay["schedules"]) by_method[schedule["method"]] = schedule;
        ASSERT_EQ(by_method.size(), 6U);
        const auto& hindsight = by_method["hindsight"];
        EXPECT_EQ(hindsight["keeps_reserve"].get<bool>(), !replay["bound"].is_null());
        for (const auto& [method, schedule] : by_method) {
            EXPECT_NEAR(schedule["mechanical_energy_wh"].get<double>(), replay["measured_mechanical_wh"].get<double>(),
                        1e-9)
                << method;
            if (!schedule["keeps_reserve"]) continue;
            ASSERT_TRUE(hindsight["keeps_reserve"]) << method;
            EXPECT_LE(schedule["utility"].get<double>(), replay["bound"].get<double>() * (1.0 + 1e-9)) << method;
            EXPECT_GE(schedule["regret"].get<double>(), 0.0) << method;
        }
    }
    EXPECT_EQ(json["comparisons"].size(), 2U);
    EXPECT_EQ(json["comparisons"][0]["flights"].size(), 3U);
}

}  // namespace
}  // namespace flightwatt::mission

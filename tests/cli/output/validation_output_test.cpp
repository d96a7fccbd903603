// Tables, verdict and JSON of a validation of generated flights.

#include "cli/output/validation_output.h"

#include "helpers/generated_flights.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

const std::vector<mechanical::ValidatedFlight>& validated() {
    static const auto flights = mechanical::leave_one_out(test::generated(4, 7));
    return flights;
}

TEST(ScoresTable, HasTheScoreOfEveryPhaseAndModel) {
    const auto table = scores_table(validated());
    ASSERT_EQ(table.rows.size(), 4 * model_names(validated()).size());
    const auto& first = table.rows.front();
    EXPECT_EQ(first[0], "takeoff");
    EXPECT_EQ(first[1], "fourier");
    const auto score = score_of(validated(), "fourier", flight::Phase::takeoff);
    EXPECT_EQ(first[3], fmt::format("{:.3f}", score->mean_absolute_error_wh));
    EXPECT_EQ(table.rows.back()[0], "total");
}

TEST(FlightsTable, HasMeasuredAndPredictedEnergyOfEachFlight) {
    const auto table = flights_table(validated());
    EXPECT_EQ(table.rows.size(), std::size_t{4} * 4 * model_names(validated()).size());
    for (const auto& row : table.rows) {
        EXPECT_NEAR(std::stod(row[5]) - std::stod(row[3]), std::stod(row[6]), 1.1e-3) << "the error";
        if (row[1] == "landing") {
            EXPECT_EQ(row[7], "-") << "its power is near zero";
        }
    }
}

TEST(Verdict, ComparesPhaseByPhaseAndIsSilentOnTies) {
    EXPECT_EQ(verdict(validated(), "fourier", "fourier"), "");
    EXPECT_EQ(verdict(validated(), "fourier", "unknown"), "");
    const auto text = verdict(validated(), "fourier", "constant_mean");
    const auto back = verdict(validated(), "constant_mean", "fourier");
    const bool better = score_of(validated(), "fourier", std::nullopt)->mean_absolute_error_wh <
                        score_of(validated(), "constant_mean", std::nullopt)->mean_absolute_error_wh;
    EXPECT_THAT(
        text, HasSubstr(better ? "total: fourier beats constant_mean" : "total: fourier does not beat constant_mean"));
    EXPECT_THAT(
        back, HasSubstr(better ? "total: constant_mean does not beat fourier" : "total: constant_mean beats fourier"));
}

TEST(ScoresJson, HoldsTheScoresAsNumbers) {
    const auto json = scores_json(validated());
    EXPECT_EQ(json["flights"], 4);
    const auto score = score_of(validated(), "fourier", flight::Phase::cruise);
    EXPECT_EQ(json["cruise"]["fourier"]["bias_wh"], score->bias_wh);
    EXPECT_TRUE(json["landing"]["fourier"]["mean_absolute_error_percent"].is_null());
}

}  // namespace
}  // namespace flightwatt::cli

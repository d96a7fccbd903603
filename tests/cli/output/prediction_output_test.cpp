// What predict prints, of a prediction made by hand.

#include "cli/output/prediction_output.h"

#include "helpers/generated_flights.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

Prediction made_up() {
    Prediction prediction;
    prediction.flown.energy_wh = 1.0;
    prediction.flown.cruise_start_s = 50.0;
    prediction.flown.until_s = 100.0;
    prediction.remaining_s = 360.0;
    prediction.cruise.remaining_mean_w = 20.0;
    prediction.cruise.gain = 0.25;
    prediction.cruise.energy.energy_wh = 2.0;
    prediction.landing.energy_wh = 0.5;
    prediction.landing_s = 90.0;
    prediction.remaining_energy.energy_wh = 2.5;
    prediction.interval = {2.0, 3.0};
    return prediction;
}

TEST(PredictionOutput, SaysWhatWasExpectedSoFar) {
    auto prediction = made_up();
    EXPECT_THAT(text_of(prediction), HasSubstr("expected 0.00 W"));
    EXPECT_EQ(record_json(prediction)["cruise"]["gain"], 0.25);
    prediction.uses_physical_model = true;
    EXPECT_THAT(text_of(prediction), HasSubstr("no measured airspeed to compare with"));
    EXPECT_TRUE(record_json(prediction)["cruise"]["own_level"].is_null());
    prediction.flown.motion.bins.resize(2);
    EXPECT_THAT(text_of(prediction), HasSubstr("expected 0.00 W"));
    EXPECT_EQ(record_json(prediction)["cruise"]["own_level"], 0.25);
    EXPECT_TRUE(record_json(prediction)["cruise"]["gain"].is_null());
}

TEST(PredictionOutput, HasTheRestOfATakeoff) {
    auto prediction = made_up();
    prediction.flown.cruise_start_s = prediction.flown.until_s;
    prediction.takeoff_s = 12.0;
    prediction.takeoff.energy_wh = 0.25;
    EXPECT_THAT(text_of(prediction), HasSubstr("take-off   0.250 Wh in 12.0 s more"));
    EXPECT_THAT(text_of(prediction), HasSubstr("20.00 W; not begun"));
    const auto json = record_json(prediction);
    EXPECT_EQ(json["takeoff"]["remaining_s"], 12.0);
    EXPECT_TRUE(json["cruise"]["flown_mean_w"].is_null());
}

TEST(PredictionOutput, SaysHowTheBatteryLands) {
    auto prediction = made_up();
    live::BatteryPrediction of;
    of.expected.soc_percent = 65.0;
    of.expected.voltage_v = 10.0;
    prediction.battery = of;
    EXPECT_THAT(text_of(prediction), HasSubstr("65.0 % and 10.00 V at landing"));
}

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

TEST(ScoresJson, HoldsTheScoresAsNumbers) {
    const auto json = record_json(ValidationOutput{validated(), 4});
    EXPECT_EQ(json["flights"], 4);
    const auto score = score_of(validated(), "fourier", flight::Phase::cruise);
    EXPECT_EQ(json["cruise"]["fourier"]["bias_wh"], score->bias_wh);
    EXPECT_TRUE(json["landing"]["fourier"]["mean_absolute_error_percent"].is_null());
}

}  // namespace
}  // namespace flightwatt::cli

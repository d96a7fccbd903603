// What predict prints, of a prediction made by hand.

#include "cli/output/prediction_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

Prediction made_up() {
    Prediction prediction;
    prediction.flown.energy_wh = 1.0;
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

TEST(PredictionOutput, SaysWhatTheDifferenceSoFarMeans) {
    auto prediction = made_up();
    EXPECT_THAT(text_of(prediction), HasSubstr("of the difference 25 % goes on"));
    EXPECT_EQ(json_of(prediction)["cruise"]["gain"], 0.25);
    prediction.uses_physical_model = true;
    EXPECT_THAT(text_of(prediction), HasSubstr("own level is not known"));
    EXPECT_TRUE(json_of(prediction)["cruise"]["own_level"].is_null());
    prediction.flown.motion.bins.resize(2);
    EXPECT_THAT(text_of(prediction), HasSubstr("this flight's own level +25.0 %"));
    EXPECT_EQ(json_of(prediction)["cruise"]["own_level"], 0.25);
    EXPECT_FALSE(json_of(prediction)["cruise"].contains("gain"));
}

TEST(PredictionOutput, SaysHowTheBatteryLands) {
    auto prediction = made_up();
    live::BatteryPrediction of;
    of.expected.soc_percent = 65.0;
    of.expected.voltage_v = 10.0;
    prediction.battery = of;
    EXPECT_THAT(text_of(prediction), HasSubstr("65.0 % and 10.00 V at landing"));
}

}  // namespace
}  // namespace flightwatt::cli

#include "live/live_curves.h"

#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

TEST(LiveCurves, TheChargeAheadEndsWithThePrediction) {
    PredictionInput basis;
    basis.battery = battery::Battery{};
    basis.battery->voltage_v = 10.0;
    basis.battery->capacity_ah = 1.0;
    LiveState state;
    EXPECT_TRUE(soc_ahead(state, basis).time_s.empty());
    state.time_s = 50.0;
    state.prediction.emplace();
    state.prediction->cruise.remaining_mean_w = 10.0;
    state.prediction->remaining_s = 1800.0;
    state.prediction->landing.energy_wh = 0.5;
    state.prediction->landing_s = 100.0;
    state.battery.emplace();
    state.battery->state = battery::BatteryState{90.0, 0.0};
    const auto curve = soc_ahead(state, basis);
    EXPECT_NEAR(curve.time_s.back(), 1950.0, 1e-6);
    EXPECT_NEAR(curve.value.back(), 35.0, 1e-6) << "5.5 Wh of 10";
    EXPECT_LT(curve.time_s.size(), 120U);
    state.battery->state->soc_percent = 20.0;
    EXPECT_LT(soc_ahead(state, basis).time_s.back(), 50.0 + 721.0) << "2 Wh at 10 W";
}

}  // namespace
}  // namespace flightwatt::live

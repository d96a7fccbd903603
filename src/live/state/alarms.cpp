#include "live/state/alarms.h"

#include "base/statistics.h"
#include "base/units.h"

#include <cmath>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

std::string reserve_text(const BatteryPrediction& battery, const std::optional<double>& chance) {
    const auto& landing = battery.expected.keeps_reserve ? battery.worst : battery.expected;
    const auto* at = battery.expected.keeps_reserve ? "at the high end of the energy's interval " : "";
    auto text = landing.fails_after_s ? fmt::format("{}the battery fails in {:.1f} min, before the landing", at,
                                                    *landing.fails_after_s / 60.0)
                                      : fmt::format("{}{:.1f} % at landing, short of the reserve of {:g} %", at,
                                                    landing.soc_percent, battery.limits.reserve_soc_percent);
    if (chance) text += fmt::format("; chance of landing below it {:.0f} %", units::percentage(*chance, 1.0));
    return text;
}

/// How far the cruise so far is off, where that is beyond 95 of 100 flights.
std::string model_text(const Prediction& prediction, const PredictionInput& basis) {
    if (prediction.uses_physical_model) {
        const auto& model = basis.model.physical.value();
        const double level = prediction.cruise.gain;
        if (!model.level_sd || prediction.flown.motion.bins.empty()) return "";
        const double reach = *model.level_sd * student_t_half_width(model.degrees_of_freedom);
        if (std::abs(level) <= reach) return "";
        return fmt::format("this flight takes {:+.1f} % of what the model says; 95 of 100 flights lie within {:.1f} %",
                           units::percentage(level, 1.0), units::percentage(reach, 1.0));
    }
    const auto cruise_s = prediction.flown.cruise_s();
    const auto expected = predict_before_flight(forecast_of(basis.model, flight::Phase::cruise), cruise_s);
    const auto interval = interval_95(expected);
    const double measured_wh = prediction.flown.cruise_energy_wh;
    if (!interval || interval->contains(measured_wh)) return "";
    return fmt::format("the cruise so far took {:.3f} Wh; the model expected {:.3f} to {:.3f} Wh of 95 in 100 flights",
                       measured_wh, interval->low_wh, interval->high_wh);
}

}  // namespace

std::vector<Alarm> alarms_of(const LiveState& state, const std::optional<PredictionInput>& basis, double silence_s) {
    std::vector<Alarm> alarms;
    if (state.time_since_message_s >= silence_s) {
        alarms.push_back({"silence", fmt::format("nothing was received for {:.0f} s", state.time_since_message_s)});
    }
    if (state.prediction) {
        if (const auto& battery = state.prediction->battery; battery && !battery->worst.keeps_reserve)
            alarms.push_back({"reserve", reserve_text(*battery, state.battery->probability_below_reserve)});
        if (auto text = model_text(*state.prediction, *basis); !text.empty())
            alarms.push_back({"model", std::move(text)});
    }
    if (state.phase && state.battery && state.battery->voltage_residual_v.value_or(0.0) < -failing_cell_v) {
        alarms.push_back({"voltage", fmt::format("the voltage is {:.2f} V below what the battery's model says: a cell "
                                                 "may be failing, or it is another pack",
                                                 -*state.battery->voltage_residual_v)});
    }
    return alarms;
}

}  // namespace flightwatt::live

#include "live/state/soc_estimation.h"

#include "base/statistics.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/toms748_solve.hpp>

namespace flightwatt::live {
namespace {

constexpr double failed_percent = -200.0;    // surplus where the battery fails before the landing
constexpr double other_pack_percent = 15.0;  // increase of the resting state of charge that only another pack explains

/// Without a record: by voltage and current of the last minute, with the RC pair at rest.
void estimate_soc_from_voltage(const battery::Battery& battery, const flight::FlightData& data, LiveBattery& result) {
    const auto& voltage = data.voltage_v;
    if (!battery.thevenin || voltage.empty()) return;
    const auto& current = data.current_a;
    std::vector<double> rest_v;
    for (std::size_t i = voltage.time_s.size(); i-- > 0 && voltage.time_s[i] >= voltage.time_s.back() - watched_s;) {
        const double current_a = current.empty() ? 0.0 : value_at(current, voltage.time_s[i]);
        rest_v.push_back(voltage.value[i] + battery.resistance_ohm * current_a);
    }
    if (rest_v.size() < enough_samples) return;
    const double now_v = median(std::move(rest_v));
    result.soc_by_voltage_percent = battery::resting_soc_percent(battery, now_v);
    result.soc_by_voltage_sd_percent = battery::resting_soc_sd_percent(battery, now_v);
    result.initial = {*result.soc_by_voltage_percent, result.soc_by_voltage_sd_percent};
    result.state = battery::BatteryState{*result.soc_by_voltage_percent, 0.0};
}

/// State of charge at landing above the reserve, for a factor of the expected energy and deviations of the capacity and
/// the initial charge in standard deviations, as in draws of flights.
double surplus_percent(const PredictionInput& input, const Prediction& prediction, const LiveBattery& now,
                       battery::Battery& battery, double energy_factor, double capacity_sds, double charge_sds) {
    const double nominal_ah = input.battery->capacity_ah;
    if (const auto& interval = battery.intervals.capacity_ah) {
        const double half_width_ah = capacity_sds < 0.0 ? nominal_ah - interval->low : interval->high - nominal_ah;
        const double capacity_ah = nominal_ah + capacity_sds * half_width_ah / normal_half_width();
        battery.capacity_ah = std::max(0.01 * nominal_ah, capacity_ah);
    }
    const auto from = battery_now(now);
    const auto state = state_for(from, nominal_ah, battery.capacity_ah, charge_sds * from.initial.sd_percent);
    if (!(state.soc_percent > 0.0)) return failed_percent;
    const auto ahead = remaining_power(prediction, std::max(0.0, energy_factor));
    const auto landing = battery::forecast_landing(battery, state, ahead, 0.0, input.limits);
    return landing.fails_after_s ? failed_percent : landing.soc_percent - input.limits.reserve_soc_percent;
}

/// The state of charge where the record begins: continued, given or by the resting voltage.
InitialCharge initial_of(const PredictionInput& input, const std::optional<InitialCharge>& carried,
                         const battery::DischargeRecord& record) {
    const bool continues = carried && !record.is_other_pack;
    if (!continues) return initial_charge(input, record);
    if (!input.battery->thevenin) return *carried;
    const auto by_voltage = initial_charge_by_voltage(input, record);
    return by_voltage.soc_percent > carried->soc_percent + other_pack_percent ? by_voltage : *carried;
}

}  // namespace

void use_voltage_if_lower(LiveBattery& now) {
    if (!now.state || !now.soc_by_voltage_percent || *now.soc_by_voltage_percent >= now.state->soc_percent) return;
    now.state->soc_percent = *now.soc_by_voltage_percent;
    now.is_by_voltage = true;
}

BatteryNow battery_now(const LiveBattery& now) {
    if (now.is_by_voltage) return {now.state.value(), 0.0, {now.state->soc_percent, now.soc_by_voltage_sd_percent}};
    return {now.state.value(), now.soc_percent ? now.drawn_ah.value_or(0.0) : 0.0, now.initial};
}

LiveBattery estimate_soc(const PredictionInput& input, const std::optional<InitialCharge>& carried,
                         const flight::FlightData& data, std::optional<battery::DischargeRecord>& record) {
    const auto& battery = input.battery.value();
    LiveBattery result;
    try {
        record = battery::discharge_records(data).records.back();
        result.initial = initial_of(input, carried, *record);
        result.drawn_ah = record->charge_ah.back();
        result.state = state_after(battery, *record, result.initial.soc_percent);
        result.state->soc_percent =
            std::min(result.state->soc_percent, units::percent_per_whole);  // a counter ran back
        result.soc_percent = result.state->soc_percent;
        if (const auto by_voltage = check_voltage(battery, *record, result.initial.soc_percent)) {
            result.voltage_residual_v = by_voltage->residual_v;
            result.voltage_explained_v = by_voltage->explained_v;
            result.soc_by_voltage_percent = by_voltage->soc_percent;
            result.soc_by_voltage_sd_percent = by_voltage->sd_percent;
        }
    } catch (const std::exception&) {  // no record yet, or more charge drawn than available
        estimate_soc_from_voltage(battery, data, result);
    }
    return result;
}

std::optional<double> probability_below_reserve(const PredictionInput& input, const Prediction& prediction,
                                                const LiveBattery& now) {
    constexpr double max_sds = 8.0;
    const auto& rest = prediction.remaining_energy;
    if (!rest.uncertainty_known || !(rest.energy_wh > 0.0)) return std::nullopt;
    const double energy_sd = std::sqrt(rest.variance_wh2) / rest.energy_wh;
    auto battery = input.battery.value();  // a copy for all evaluations
    const auto surplus = [&](double energy_sds, double capacity_sds, double charge_sds) {
        return surplus_percent(input, prediction, now, battery, 1.0 + energy_sds * energy_sd, capacity_sds, charge_sds);
    };
    // Direction to the most probable failure: each quantity in proportion to the effect of its deviation.
    const double expected = surplus(0.0, 0.0, 0.0);
    const double energy_effect = std::max(0.0, expected - surplus(1.0, 0.0, 0.0));
    const double capacity_effect =
        input.battery->intervals.capacity_ah ? std::max(0.0, expected - surplus(0.0, -1.0, 0.0)) : 0.0;
    const double charge_sd = battery_now(now).initial.sd_percent;
    const double charge_effect = charge_sd > 0.0 ? std::max(0.0, expected - surplus(0.0, 0.0, -1.0)) : 0.0;
    const double all = std::hypot(energy_effect, capacity_effect, charge_effect);
    const double by_energy = all > 0.0 ? energy_effect / all : 1.0;
    const double by_capacity = all > 0.0 ? capacity_effect / all : 0.0;
    const double by_charge = all > 0.0 ? charge_effect / all : 0.0;
    const auto along = [&](double sds) { return surplus(sds * by_energy, -sds * by_capacity, -sds * by_charge); };
    const double at_low = along(-max_sds);
    const double at_high = along(max_sds);
    if (!(at_low > 0.0)) return 1.0;
    if (at_high >= 0.0) return 0.0;
    std::uintmax_t max_evaluations = 30;
    constexpr int bits = 12;  // a hundredth of a standard deviation
    const auto [low, high] = boost::math::tools::toms748_solve(
        along, -max_sds, max_sds, at_low, at_high, boost::math::tools::eps_tolerance<double>(bits), max_evaluations);
    const double sds = 0.5 * (low + high);
    const double energy_fraction = by_energy * by_energy;  // of the variance
    if (!(rest.satterthwaite_sum > 0.0) || !(energy_fraction > 0.0)) return cdf(complement(boost::math::normal(), sds));
    const double degrees = rest.variance_wh2 * rest.variance_wh2 / rest.satterthwaite_sum;
    return cdf(complement(boost::math::students_t(degrees / (energy_fraction * energy_fraction)), sds));
}

}  // namespace flightwatt::live

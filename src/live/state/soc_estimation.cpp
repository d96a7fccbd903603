#include "base/statistics.h"
#include "base/units.h"
#include "flight/selected_track.h"
#include "live/state/moment.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <functional>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/toms748_solve.hpp>

namespace flightwatt::live {
namespace {

constexpr double watched_s = 60.0;         // for the voltage
constexpr std::size_t enough_samples = 5;  // in there
constexpr double failed_percent = 200.0;   // below the reserve: where the battery fails it does not land

/// Measured voltage, and what it would be at rest with the RC pair settled, over the last minute.
void compare_voltage(const battery::Battery& battery, const battery::DischargeRecord& record, LiveBattery& result) {
    if (!battery.thevenin || record.time_s.empty()) return;
    const auto settled_a = rc_branch_current_a(record, battery.thevenin->rc_time_constant_s);
    std::vector<double> off_v;
    std::vector<double> rest_v;
    for (std::size_t i = record.time_s.size(); i-- > 0 && record.time_s[i] >= record.time_s.back() - watched_s;) {
        if (!record.used[i]) continue;
        const double lost_v =
            battery.resistance_ohm * record.current_a[i] + battery.thevenin->rc_resistance_ohm * settled_a[i];
        rest_v.push_back(record.voltage_v[i] + lost_v);
        const auto soc = soc_at(battery, record, result.initial_soc_percent, record.time_s[i]);
        off_v.push_back(rest_v.back() - open_circuit_voltage_v(battery, std::clamp(*soc, 0.0, 100.0)));
    }
    if (off_v.size() < enough_samples) return;
    result.voltage_residual_v = median(std::move(off_v));
    result.soc_by_voltage_percent = battery::resting_soc_percent(battery, median(std::move(rest_v)));
}

/// Of a series without a record: by voltage and current of the last minute, as if nothing had settled yet.
void estimate_soc_from_voltage(const battery::Battery& battery, const flight::SelectedTracks& tracks,
                               LiveBattery& result) {
    const auto& voltage = tracks["voltage_v"];
    if (!battery.thevenin || voltage.empty()) return;
    const auto& current = tracks["current_a"];
    std::vector<double> rest_v;
    for (std::size_t i = voltage.time_s.size(); i-- > 0 && voltage.time_s[i] >= voltage.time_s.back() - watched_s;) {
        const double current_a = current.empty() ? 0.0 : value_at(current, voltage.time_s[i]);
        rest_v.push_back(voltage.value[i] + battery.resistance_ohm * current_a);
    }
    if (rest_v.size() < enough_samples) return;
    result.soc_by_voltage_percent = battery::resting_soc_percent(battery, median(std::move(rest_v)));
    result.state = battery::BatteryState{*result.soc_by_voltage_percent, 0.0};
}

constexpr double max_sds = 8.0;

/// So many deviations away nothing is spare: what is spare is nearly straight in them, so that two secants find it;
/// where the battery fails in between, the root is bracketed. std::nullopt beyond `low` and eight.
std::optional<double> sds_without_spare(const std::function<double(double)>& spare_percent, double low) {
    constexpr double exact_percent = 0.02;
    double before = 0.0;
    double sds = 2.0;
    double spare_before = spare_percent(before);
    for (int i = 0; i < 3; ++i) {
        const double spare = spare_percent(sds);
        const double slope = (spare - spare_before) / (sds - before);
        const bool is_straight = slope < 0.0 && spare > -failed_percent && spare_before > -failed_percent;
        if (!is_straight) break;
        before = sds;
        spare_before = spare;
        sds -= spare / slope;
        if (sds <= low || sds >= max_sds) return std::nullopt;
        if (std::abs(spare) < exact_percent) return sds;
    }
    if (spare_percent(low) < 0.0 || spare_percent(max_sds) >= 0.0) return std::nullopt;
    std::uintmax_t max_looks = 12;
    constexpr int bits = 11;  // less than a hundredth of a standard deviation
    const auto [below, above] = boost::math::tools::toms748_solve(
        spare_percent, low, max_sds, boost::math::tools::eps_tolerance<double>(bits), max_looks);
    return 0.5 * (below + above);
}

/// What is spare at the landing with a part of the expected energy and another capacity.
class Spare {
  public:
    Spare(const PredictionInput& basis, const Prediction& prediction, const LiveBattery& now)
        : basis_(basis), prediction_(prediction), state_(now.state.value()), battery_(basis.battery.value()) {
        if (now.soc_percent) drawn_ah_ = now.drawn_ah.value_or(0.0);
    }

    /// `capacity_sds`: by so many deviations, as in draws of flights.
    double percent(double part, double capacity_sds) {
        const double as_it_is_ah = basis_.battery->capacity_ah;
        battery_.capacity_ah = std::max(0.01 * as_it_is_ah, as_it_is_ah + capacity_sds * capacity_sd_ah(capacity_sds));
        auto state = state_;
        state.soc_percent +=
            units::percentage(drawn_ah_, as_it_is_ah) - units::percentage(drawn_ah_, battery_.capacity_ah);
        if (!(state.soc_percent > 0.0)) return -failed_percent;
        state.soc_percent = std::min(state.soc_percent, units::percent_per_whole);
        const auto landing =
            battery::forecast_landing(battery_, state, remaining_power(prediction_, part), 0.0, basis_.limits);
        return landing.fails_after_s ? -failed_percent : landing.soc_percent - basis_.limits.reserve_soc_percent;
    }

  private:
    double capacity_sd_ah(double sds) const {
        const auto& interval = basis_.battery->intervals.capacity_ah;
        if (!interval) return 0.0;
        const double capacity_ah = basis_.battery->capacity_ah;
        return (sds < 0.0 ? capacity_ah - interval->low : interval->high - capacity_ah) / normal_half_width();
    }

    const PredictionInput& basis_;
    const Prediction& prediction_;
    battery::BatteryState state_;
    battery::Battery battery_;
    double drawn_ah_ = 0.0;  ///< of which the state of charge was told
};

/// A pack that rests at a voltage of so many points more than was left in the one before is another one.
constexpr double other_pack_percent = 15.0;

/// The state of charge where the record begins, and whether its voltage told it.
void set_initial(const PredictionInput& basis, const std::optional<double>& carried_percent,
                 const battery::DischargeRecord& record, LiveBattery& result) {
    result.initial_is_from_voltage = !basis.initial_soc_percent;
    const bool goes_on = carried_percent && !record.is_other_pack;
    result.initial_soc_percent = goes_on ? *carried_percent : initial_soc_percent(basis, record);
    if (!goes_on || !basis.battery->thevenin) return;
    const double by_voltage = initial_soc_by_voltage_percent(basis, record);
    result.initial_is_from_voltage = by_voltage > result.initial_soc_percent + other_pack_percent;
    if (result.initial_is_from_voltage) result.initial_soc_percent = by_voltage;
}

}  // namespace

std::optional<double> soc_at(const battery::Battery& battery, const battery::DischargeRecord& record,
                             double initial_soc_percent, double time_s) {
    const auto after = std::ranges::upper_bound(record.time_s, time_s);
    if (after == record.time_s.begin()) return std::nullopt;
    const auto index = static_cast<std::size_t>(after - record.time_s.begin()) - 1;
    return initial_soc_percent - units::percentage(record.charge_ah[index], battery.capacity_ah);
}

LiveBattery estimate_soc(const PredictionInput& basis, const std::optional<double>& carried_percent,
                         const flight::SelectedTracks& tracks, std::optional<battery::DischargeRecord>& record) {
    const auto& battery = basis.battery.value();
    LiveBattery result;
    try {
        record = battery::discharge_records(tracks).records.back();
        set_initial(basis, carried_percent, *record, result);
        result.drawn_ah = record->charge_ah.back();
        result.state = state_after(battery, *record, result.initial_soc_percent);
        result.state->soc_percent =
            std::min(result.state->soc_percent, units::percent_per_whole);  // a counter ran back
        result.soc_percent = result.state->soc_percent;
        compare_voltage(battery, *record, result);
    } catch (const std::exception&) {  // no record yet, or more was drawn than there was
        estimate_soc_from_voltage(battery, tracks, result);
    }
    return result;
}

void estimate_soc_from_counter(const PredictionInput& basis, const flight::FlightSeries& series, LiveBattery& result) {
    const auto charge = flight::select_track(series, "charge_ah");
    if (!basis.initial_soc_percent || charge.empty() || result.soc_percent) return;
    const double drawn_ah = charge.value.back();
    const double left_percent = *basis.initial_soc_percent - units::percentage(drawn_ah, basis.battery->capacity_ah);
    if (!(drawn_ah > 0.0) || !(left_percent > 0.0)) return;  // it began anew, or counts another pack
    result.drawn_ah = drawn_ah;
    result.initial_soc_percent = *basis.initial_soc_percent;
    result.soc_percent = left_percent;
    result.state = battery::BatteryState{left_percent, 0.0};
}

std::optional<double> probability_below_reserve(const PredictionInput& basis, const Prediction& prediction,
                                                const LiveBattery& now) {
    const auto& rest = prediction.remaining_energy;
    if (!rest.uncertainty_known || !(rest.energy_wh > 0.0)) return std::nullopt;
    const double sd = std::sqrt(rest.variance_wh2) / rest.energy_wh;
    Spare spare(basis, prediction, now);
    const double expected = spare.percent(1.0, 0.0);
    // The way to less that is the likeliest: along it each of the two counts by what a deviation of it takes.
    double by_energy = 1.0;
    double by_capacity = 0.0;
    if (basis.battery->intervals.capacity_ah) {
        const double energy_takes = expected - spare.percent(1.0 + sd, 0.0);
        const double capacity_takes = expected - spare.percent(1.0, -1.0);
        const double both = std::hypot(energy_takes, capacity_takes);
        if (both > 0.0) by_energy = std::max(0.0, energy_takes / both);
        if (both > 0.0) by_capacity = std::max(0.0, capacity_takes / both);
    }
    const auto spare_percent = [&](double sds) {
        return spare.percent(std::max(0.0, 1.0 + sds * by_energy * sd), -sds * by_capacity);
    };
    const auto sds = sds_without_spare(spare_percent, -max_sds);
    if (!sds) return expected < 0.0 ? 1.0 : 0.0;
    const double energy_fraction = by_energy * by_energy;  // of the variance
    if (!(rest.satterthwaite_sum > 0.0) || !(energy_fraction > 0.0))
        return cdf(complement(boost::math::normal(), *sds));
    const double degrees = rest.variance_wh2 * rest.variance_wh2 / rest.satterthwaite_sum;
    return cdf(complement(boost::math::students_t(degrees / (energy_fraction * energy_fraction)), *sds));
}

}  // namespace flightwatt::live
